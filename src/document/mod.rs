//! A leaf as a person writes it: TOML in which every number may be a range.
//!
//! A [`Document`] is a flat list from dotted key to value, checked against the knobs that the stages
//! declare ([`crate::parameter`]). Presets, files and `--set` lay documents over each other;
//! [`Document::resolve`] draws one value for every range and gives the plain [`LeafSpec`] the stages
//! work with. Each key draws from a stream of its own, so setting one leaves the others as they were.
//!
//! Lists of records are keys too, with the number of the record in them (`margin.lobe.2.angle_deg`):
//! a `[[margin.lobe]]` in a file replaces the list that was there, one key changes one record.

mod draw;
mod parse;
mod records;
mod schema;
mod value;
mod write;

use std::collections::{BTreeMap, BTreeSet};
use std::sync::LazyLock;

use crate::margin::MarginSpec;
use crate::parameter::{Parameter, Parameters};
use crate::spec::LeafSpec;
use crate::spelling;
pub use schema::schema;
pub use value::Value;

/// Every knob of a leaf, in the order in which files show them.
static PARAMETERS: LazyLock<Vec<Parameter>> = LazyLock::new(LeafSpec::parameters);

/// Every knob of a leaf, in the order in which files show them.
#[must_use]
pub fn parameters() -> &'static [Parameter] {
    &PARAMETERS
}

/// What is wrong with the description of a leaf.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{origin}: {problem}")]
pub struct DocumentError {
    /// Where it was said: `beech.toml:12`, `--set`, …
    pub origin: String,
    /// The key, the value, the limit and what to do.
    pub problem: String,
}

/// A value and where it was said.
#[derive(Debug, Clone, PartialEq)]
struct Entry {
    value: Value,
    origin: String,
}

/// The description of a leaf: the keys that were given, and the seed if one was.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Document {
    entries: BTreeMap<String, Entry>,
    /// The lists of records that are given whole.
    lists: BTreeSet<String>,
    /// The seed written in the file, which the command line may override.
    pub seed: Option<u64>,
    /// By up to how many percent every number of the margin is perturbed, on top of the ranges
    /// (`vary = 20`); see [`crate::margin::instances`].
    pub vary: Option<f64>,
    /// Whether the margin is perturbed for [`seed`](Self::seed) too: when asked for by
    /// [`set`](Self::set). A file that names a seed and `vary` is the leaf of that seed as it stands, and
    /// the percentage says how far those of other seeds differ from it.
    varies_own_seed: bool,
}

impl Document {
    /// A document that gives nothing: every value is the default.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Reads TOML. `origin` names the text in errors.
    ///
    /// # Errors
    ///
    /// Syntax, unknown keys (with the nearest known one), wrong types, values out of their limits,
    /// ranges that run backwards; each with its line.
    pub fn parse(text: &str, origin: &str) -> Result<Self, DocumentError> {
        parse::document(text, origin)
    }

    /// Sets one key from `key=value` as typed on a command line; `min..max` is a range,
    /// `20±10%` one around a middle.
    ///
    /// # Errors
    ///
    /// As [`Document::parse`].
    pub fn set(&mut self, assignment: &str, origin: &str) -> Result<(), DocumentError> {
        if let Some(percent) = parse::variation(assignment, origin)? {
            self.vary = Some(percent);
            self.varies_own_seed = true;
            return Ok(());
        }
        let (key, value) = parse::assignment(assignment, origin)?;
        self.insert(&key, value, origin);
        Ok(())
    }

    /// Sets one key to a checked value.
    ///
    /// # Panics
    ///
    /// If no parameter has that key: the caller names it in its source.
    pub fn insert(&mut self, key: &str, value: Value, origin: &str) {
        assert!(records::listed(key).is_some(), "{key} is not a parameter");
        self.entries.insert(key.to_owned(), Entry { value, origin: origin.to_owned() });
    }

    /// Sets every key of a group to the values of its settings: `insert_group("margin", &spec, …)`.
    ///
    /// # Panics
    ///
    /// If there is no such group, or the settings are not its own: the caller names it in its source.
    pub fn insert_group<T: serde::Serialize>(&mut self, group: &str, settings: &T, origin: &str) {
        let plain = toml::Value::try_from(settings).expect("settings are plain data");
        draw::insert_tree(self, group, &plain, origin);
    }

    /// Whether a key was given.
    #[must_use]
    pub fn gives(&self, key: &str) -> bool {
        self.entries.contains_key(key)
    }

    /// Where a key was given: `beech.toml:12`, `--set`, …
    #[must_use]
    pub fn origin(&self, key: &str) -> Option<&str> {
        self.entries.get(key).map(|entry| &*entry.origin)
    }

    /// Lays another document over this one: what it gives replaces what this gave.
    pub fn overlay(&mut self, over: Self) {
        for list in over.lists {
            self.start_list(&list);
        }
        self.entries.extend(over.entries);
        self.seed = over.seed.or(self.seed);
        if over.vary.is_some() {
            (self.vary, self.varies_own_seed) = (over.vary, over.varies_own_seed);
        }
    }

    /// Gives the whole outline anew: forgets every `margin.` key that was given and sets all of them.
    ///
    /// # Panics
    ///
    /// If the lists of the specification run past what a document can hold; fitted ones never do.
    pub fn set_margin(&mut self, margin: &MarginSpec, origin: &str) {
        const GROUP: &str = "margin.";
        self.entries.retain(|key, _| !key.starts_with(GROUP));
        let spec = LeafSpec { margin: margin.clone(), ..LeafSpec::default() };
        for (key, entry) in draw::document_of(&spec, 0).entries {
            if key.starts_with(GROUP) {
                self.entries.insert(key, Entry { value: entry.value, origin: origin.to_owned() });
            }
        }
    }

    /// Forgets the records of a list: those that follow are all of it.
    fn start_list(&mut self, list: &str) {
        self.entries.retain(|key, _| records::number_in(key, list).is_none());
        self.lists.insert(list.to_owned());
    }

    /// How many records a list has: the highest number given. `list` as in `margin.lobe`.
    #[must_use]
    pub fn record_count(&self, list: &str) -> usize {
        let numbers = self.entries.keys().filter_map(|key| records::number_in(key, list));
        numbers.max().unwrap_or(0)
    }

    /// The value of a key: the one given, else the default.
    #[must_use]
    pub fn value(&self, key: &str) -> Option<Value> {
        match self.entries.get(key) {
            Some(entry) => Some(entry.value.clone()),
            None => value::default_of(key),
        }
    }

    /// One leaf: every range drawn with the seed's own stream for its key, the margin perturbed by
    /// [`vary`](Self::vary).
    ///
    /// # Errors
    ///
    /// When values that are each within their limits contradict each other.
    pub fn resolve(&self, seed: crate::seed::Seed) -> Result<LeafSpec, DocumentError> {
        Ok(self.resolve_varied(seed)?.0)
    }

    /// The same, and by how many percent the margin is perturbed: less than [`vary`](Self::vary) where it would
    /// be none otherwise; `None` where it is taken as it stands.
    ///
    /// # Errors
    ///
    /// As [`resolve`](Self::resolve).
    pub fn resolve_varied(
        &self,
        seed: crate::seed::Seed,
    ) -> Result<(LeafSpec, Option<f64>), DocumentError> {
        draw::resolve(self, seed)
    }

    /// The document of a resolved leaf: every key given, no range left.
    #[must_use]
    pub fn of_spec(spec: &LeafSpec, seed: u64) -> Self {
        draw::document_of(spec, seed)
    }

    /// Complete TOML: every key with its value, given or default.
    #[must_use]
    pub fn to_toml(&self, comments: Comments) -> String {
        write::toml(self, comments)
    }
}

/// The word most like a misspelt one, when one is like it at all.
#[must_use]
pub fn nearest_word<'a>(word: &str, words: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    spelling::nearest(word, spelling::LIKE_A_KEY, words)
}

/// How much [`Document::to_toml`] explains.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Comments {
    /// Keys and values.
    None,
    /// Meaning, unit and limits over every key.
    Full,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::seed::Seed;

    fn problem(text: &str) -> String {
        Document::parse(text, "leaf.toml").expect_err("this text is wrong").to_string()
    }

    #[test]
    fn a_misspelt_key_is_refused_with_its_line_and_the_nearest_key() {
        let message = problem("name = \"x\"\n[veins]\nkill_distanse_mm = 2\n");
        assert_eq!(
            message,
            "leaf.toml:3: unknown key `veins.kill_distanse_mm`; did you mean \
             `veins.kill_distance_mm`?"
        );
    }

    #[test]
    fn a_misspelt_group_and_a_key_misspelt_in_the_wrong_group_are_found_too() {
        let message = problem("[margin]\nrigth = { waist_x = 0.2 }\n");
        assert_eq!(
            message,
            "leaf.toml:2: unknown key `margin.rigth`; did you mean `margin.right`?"
        );
        assert!(problem("[colur]\ntype = \"plain\"\n").ends_with("did you mean `colour`?"));
        assert!(problem("[growth]\nsesaon = 1\n").ends_with("did you mean `state.season`?"));
        // What stands first is told first, whatever it is called.
        let message = problem("[veins]\nzzz_zzz = 1\nkill_distanse_mm = 2\n[growth]\nscal = 1\n");
        assert!(message.starts_with("leaf.toml:2: unknown key `veins.zzz_zzz`"), "{message}");
    }

    #[test]
    fn a_value_out_of_its_limits_names_the_limits() {
        let message = problem("[growth]\nscale = 3.0\n");
        assert_eq!(message, "leaf.toml:2: growth.scale = 3 is outside 0.01 to 1");
        assert!(problem("[growth]\nscale = [0.5, 2]\n").contains("0.01 to 1"));
        assert!(problem("[growth]\nscale = nan\n").contains("not a finite number"));
        assert!(problem("[growth]\nscale = inf\n").contains("not a finite number"));
        assert!(problem("[growth]\nscale = \"big\"\n").contains("a number"));
        assert!(problem("[growth]\ntotal_steps = 2.5\n").contains("whole number"));
        assert!(problem("[growth]\ntotal_steps = -1\n").contains("1 to 100000"));
    }

    #[test]
    fn a_range_that_runs_backwards_is_refused() {
        let message = problem("[growth]\nscale = [0.9, 0.5]\n");
        assert_eq!(message, "leaf.toml:2: growth.scale = 0.9..0.5 runs backwards; write 0.5..0.9");
    }

    #[test]
    fn an_unknown_word_lists_the_words() {
        let message = problem("[growth]\ntype = \"isotropc\"\n");
        assert!(message.contains("did you mean `isotropic`"), "{message}");
    }

    #[test]
    fn broken_toml_names_its_line() {
        assert!(problem("[growth\nscale = 1").starts_with("leaf.toml:1: "));
    }

    #[test]
    fn a_percent_is_a_range_around_its_middle() {
        let document = Document::parse("[margin]\nlength_mm = \"80 ± 25%\"\n", "").unwrap();
        assert_eq!(
            document.value("margin.length_mm"),
            Some(Value::Number { low: 60.0, high: 100.0 })
        );
    }

    #[test]
    fn drawing_stays_in_the_range_and_setting_one_key_leaves_the_others() {
        let mut document = Document::parse(
            "[margin]\nlength_mm = [60, 100]\n[growth]\ntotal_steps = [10, 12]\n",
            "",
        )
        .unwrap();
        let mut seen = BTreeSet::new();
        for seed in 0..200 {
            let spec = document.resolve(Seed(seed)).unwrap();
            assert!((60.0..=100.0).contains(&spec.margin.length_mm));
            seen.insert(spec.growth.total_steps);
        }
        assert_eq!(seen.into_iter().collect::<Vec<_>>(), [10, 11, 12]);
        let before = document.resolve(Seed(4)).unwrap();
        document.set("growth.total_steps=500", "--set").unwrap();
        let after = document.resolve(Seed(4)).unwrap();
        assert_eq!(after.growth.total_steps, 500);
        assert_eq!(after.margin, before.margin);
    }

    #[test]
    fn a_resolved_leaf_written_and_read_again_is_the_same_leaf() {
        let mut document = Document::parse("[margin]\nlength_mm = [60, 100]\n", "").unwrap();
        document.set("veins.sources_mm=[[1.5, 2], [3, 4]]", "--set").unwrap();
        let spec = document.resolve(Seed(9)).unwrap();
        let text = Document::of_spec(&spec, 9).to_toml(Comments::None);
        let again = Document::parse(&text, "leaf.toml").unwrap();
        assert_eq!(again.seed, Some(9));
        assert_eq!(again.resolve(Seed(9)).unwrap(), spec);
        let commented = Document::of_spec(&spec, 9).to_toml(Comments::Full);
        assert_eq!(
            Document::parse(&commented, "leaf.toml").unwrap().resolve(Seed(1)).unwrap(),
            spec
        );
    }

    #[test]
    fn records_are_listed_in_files_and_changed_one_by_one() {
        let text = "[margin]\nkind = \"lobed\"\n\n[[margin.lobe]]\nangle_deg = 90\nlower = { waist_x = 0.2 }\n\n[[margin.lobe]]\nside = \"apex\"\n";
        let mut document = Document::parse(text, "leaf.toml").unwrap();
        assert_eq!(document.record_count("margin.lobe"), 2);
        document.set("margin.lobe.1.angle_deg=40..50", "--set").unwrap();
        let angles: Vec<f64> =
            (0..50).map(|s| document.resolve(Seed(s)).unwrap().margin.lobe[0].angle_deg).collect();
        assert!(angles.iter().all(|a| (40.0..50.0).contains(a)) && angles[0] != angles[1]);
        let spec = document.resolve(Seed(1)).unwrap();
        assert_eq!(spec.margin.lobe[0].lower.waist_x, 0.2);
        assert_eq!(spec.margin.lobe[1].side, crate::margin::lobes::LobeSide::Apex);
        // Written and read again.
        let text = Document::of_spec(&spec, 1).to_toml(Comments::Full);
        assert_eq!(Document::parse(&text, "").unwrap().resolve(Seed(7)).unwrap(), spec);
        // A list laid over another replaces it; a key changes one record.
        let mut over = document.clone();
        over.overlay(Document::parse("[[margin.lobe]]\n", "").unwrap());
        assert_eq!(over.record_count("margin.lobe"), 1);
        document.overlay(Document::parse("[margin.lobe.2]\nlength = 0.5\n", "").unwrap());
        assert_eq!(document.record_count("margin.lobe"), 2);
    }

    #[test]
    fn mistakes_in_records_name_line_key_and_limit() {
        let message = problem("[[margin.lobe]]\n[[margin.lobe]]\nangle_deg = 270\n");
        assert_eq!(message, "leaf.toml:3: margin.lobe.2.angle_deg = 270 is outside 0 to 180");
        let message = problem("[[margin.lobe]]\nangel_deg = 70\n");
        assert!(
            message.contains("leaf.toml:2: unknown key `margin.lobe.1.angel_deg`"),
            "{message}"
        );
        assert!(message.contains("did you mean `margin.lobe.1.angle_deg`"), "{message}");
        assert!(problem("[margin]\nlobe = [1, 2]\n").contains("[[margin.lobe]]"));
        assert!(problem("[[growth]]\nscale = 1\n").contains("unknown key `growth`"));
        let mut document = Document::new();
        for key in ["margin.lobe.N.length", "margin.lobe.0.length", "margin.lobe.01.length"] {
            let error = document.set(&format!("{key}=0.5"), "--set").unwrap_err().to_string();
            assert!(error.contains("unknown key"), "{error}");
        }
        document.set("margin.lobe.3.length=0.5", "--set").unwrap();
        let error = document.resolve(Seed(1)).unwrap_err().to_string();
        assert!(error.contains("margin.lobe.1 is not"), "{error}");
    }

    #[test]
    fn every_default_lies_within_its_own_limits() {
        let text = Document::new().to_toml(Comments::None);
        Document::parse(&text, "defaults").unwrap();
    }
}
