//! Mistakes in arguments: each is told in one line, with what would do.

use crate::support::{contents, fail, fresh, small, venation};

#[test]
fn mistakes_are_one_line_with_code_2_and_leave_nothing() {
    let folder = fresh();
    std::fs::write(folder.path().join("file"), "").unwrap();
    std::fs::write(folder.path().join("bad.toml"), "[veins]\nkill_distanse_mm = 1\n").unwrap();
    std::fs::write(folder.path().join("binary.toml"), [0xff, 0xfe, 0x00]).unwrap();
    std::fs::write(folder.path().join("bits.toml"), "name = 'x'\n[output]\nbits = 12\n").unwrap();
    std::fs::write(folder.path().join("maps.toml"), "[output]\nmaps = 'basecolour'\n").unwrap();
    std::fs::write(folder.path().join("name.toml"), "\nname = '../up'\n").unwrap();
    let cases: &[(&[&str], &str)] = &[
        (&["generate", "beach"], "did you mean `beech`"),
        (&["generate", "nowhere.toml"], "nowhere.toml"),
        (&["generate", "bad.toml"], "bad.toml:2: unknown key `veins.kill_distanse_mm`"),
        (&["generate", "binary.toml"], "not UTF-8"),
        (&["generate", "bits.toml"], "bits.toml:3: output.bits = 12"),
        (&["generate", "maps.toml"], "maps.toml:2: output.maps: `basecolour`"),
        (&["atlas", "maps.toml"], "maps.toml:2: output.maps: `basecolour`"),
        (&["generate", "name.toml"], "name.toml:2: name = `../up`"),
        (&["generate", "beech", "--json", "--progress", "openjd"], "--progress openjd"),
        (&["atlas", "beech", "--seeds", "1-9000", "--size", "512", "-n"], "9000 leaves do not fit"),
        (&["atlas", "beech", "--padding", "18446744073709551615", "-n"], "smaller --padding"),
        (&["compare", "beech", "--by", "season", "--seeds", "1-3", "-o", "s.png"], "--seeds"),
        (&["compare", "beech", "-o", "x.jpg"], "-o: x.jpg: a PNG is written; call it x.png"),
        (&["compare", "beech", "-o", "x.apng"], "-o: x.apng: a PNG is written"),
        (
            &["compare", "beech", "--by", "season", "--frames", "2", "-o", "f.gif"],
            "-o: f.gif: a PNG is written",
        ),
        (&["fit", "nothing.png", "--sheet", "s.jpeg"], "--sheet: s.jpeg: a PNG is written"),
        (&["fit", "nothing.png", "-o", "s.png"], "-o: s.png: leaves are written as .toml"),
        (
            &["compare", "beech", "--by", "season", "--frames", "2", "-o", "s.png", "--csv", "s"],
            "--csv: a film has no measures",
        ),
        (&["generate", "beech", "--set", "veins.scale=0.1"], "veins.scale = 0.1 makes veins."),
        (&["generate", "."], "."),
        (&["generate", "beech", "--set", "veins.kil_distance_mm=1"], "veins.kill_distance_mm"),
        (&["generate", "beech", "--set", "veins.kill_distance_mm"], "is not key=value"),
        (
            &["generate", "beech", "--set", "colour.pigments.leaf.chlorophyl=3"],
            "did you mean `colour.pigments.leaf.chlorophyll_ug_cm2`",
        ),
        (&["generate", "beech", "--set", "veins.kill_distance_mm=2..1"], "runs backwards"),
        (&["generate", "beech", "--set", "veins.kill_distance_mm=nan"], "not a finite number"),
        (&["generate", "beech", "--set", "veins.kill_distance_mm=0"], "outside 0.001 to 1000"),
        (&["generate", "beech", "--size", "0"], "outside 16 to 16384"),
        (&["generate", "beech", "--size", "90000"], "outside 16 to 16384"),
        (&["generate", "beech", "--length-mm", "inf"], "not a finite number"),
        (&["generate", "beech", "-t", "0"], "--threads"),
        (&["generate", "beech", "--seeds", "3-1"], "--seeds: column 1"),
        (&["generate", "beech", "--maps", "basecolour"], "basecolor"),
        (&["generate", "beech", "--maps", "none,basecolor"], "`none` stands alone"),
        (&["generate", "beech", "--maps", "basecolor,All"], "`All` stands alone"),
        (&["generate", "beech", "--format", "none,obj"], "`none` stands alone"),
        (&["generate", "beech", "--maps", "height,"], "one word between commas"),
        (
            &["generate", "beech", "--set", "output.bits=8..16"],
            "--set: output.bits = 8..16: it takes 8 or 16, no range",
        ),
        (&["generate", "beech", "--bits", "9"], "--bits: output.bits = 9: it takes 8 or 16"),
        (&["generate", "beech", "--format", "fbx"], "fbx"),
        (&["generate", "beech", "--format", "gbl"], "did you mean `glb`"),
        (&["generate", "beech", "--outline", "nothing.png"], "nothing.png"),
        (&["generate", "beech", "--sources", "nothing.csv"], "nothing.csv"),
        (&["generate", "beech", "--growth", "fast"], "fast"),
        (&["generate", "beech", "-o", "file/below"], "file"),
        (&["generate", "beech", "--set", "name=../up"], "name"),
        (&["presets", "show", "beach"], "did you mean `beech`"),
        (&["bench", "--auxins", "zero"], "zero"),
        (&["bench", "--workload", "nothing.json"], "nothing.json"),
        (&["frobnicate"], "frobnicate"),
    ];
    for (arguments, expected) in cases {
        let message = fail(folder.path(), 2, arguments);
        assert!(message.contains(expected), "{arguments:?}: {message}");
    }
    let left: Vec<_> = contents(folder.path()).into_keys().collect();
    assert_eq!(left.len(), 6, "{left:?}");
}

#[test]
fn negative_numbers_are_told_their_limits() {
    let folder = fresh();
    let whole = "it takes a whole number from";
    let cases: &[(&[&str], &str)] = &[
        (
            &["generate", "beech", "--min-width", "-1"],
            "output.least_width_mm = -1 is outside 0 to 100",
        ),
        (&["generate", "beech", "--bits", "-8"], "output.bits = -8: it takes 8 or 16"),
        (&["generate", "beech", "--size", "-64"], "texture.size_px = -64 is outside 16 to 16384"),
        (&["generate", "beech", "--damage-seed", "-1"], "damage.seed = -1 is outside 0 to"),
        (
            &["generate", "beech", "--length-mm", "-3..4"],
            "margin.length_mm = -3 is outside 1 to 2000",
        ),
        (&["generate", "beech", "--season", "-1..0.2"], "state.season = -1 is outside 0 to 1"),
        (&["generate", "beech", "--vary", "-5%"], "vary = -5 is outside 0 to 100 %"),
        (&["generate", "beech", "--seed", "-1"], whole),
        (&["generate", "beech", "--seeds", "-1"], "`-1` is not a seed range"),
        (&["generate", "beech", "--shard", "-1/3"], "`-1/3` is not i/n"),
        (&["generate", "beech", "-t", "-1"], whole),
        (&["atlas", "beech", "--padding", "-1"], whole),
        (&["compare", "beech", "-o", "s.png", "--frames", "-2"], "2..=10000"),
        (&["morph", "oak", "maple", "--frames", "-1"], "whole number from 2 to 10000"),
        (&["morph", "oak", "maple", "--fps", "-1"], "whole number from 1 to 65535"),
        (&["morph", "oak", "maple", "--size", "-1"], "whole number from 16 to 4096"),
        (&["fit", "x.png", "--vary", "-3"], "--vary: -3 is not between 0 and 100"),
        (&["fit", "x.png", "--px-per-mm", "-3"], "--px-per-mm: -3 is not between"),
        (&["inspect", "x.png", "--tolerance", "-1"], "--tolerance: -1 is not between"),
        (&["generate", "beech", "--mips", "-1"], "--mips"),
        (
            &["generate", "beech", "--length-mm", "--size", "64"],
            "a value is required for '--length-mm",
        ),
        (&["bench", "--auxins", "-1"], "1..=10000000"),
        (&["bench", "--runs", "-1"], "1..=1000"),
    ];
    for (arguments, expected) in cases {
        let message = fail(folder.path(), 2, arguments);
        assert!(message.contains(expected), "{arguments:?}: {message}");
    }
    assert!(contents(folder.path()).is_empty());
}

#[cfg(unix)]
#[test]
fn names_that_are_no_text_are_told() {
    use std::os::unix::ffi::OsStrExt as _;
    let folder = fresh();
    let named =
        |start: &[u8]| std::ffi::OsStr::from_bytes(&[start, b"caf\xe9.png"].concat()).to_owned();
    for arguments in [&["generate"][..], &["compare", "beech", "-o"]] {
        let mut command = venation(folder.path(), arguments);
        let output = command.arg(named(b"")).output().unwrap();
        let message = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{message}");
        assert!(message.contains("caf\u{fffd}.png"), "{message}");
        assert!(message.contains("not UTF-8 text"), "{message}");
    }
    // A folder may have any name.
    let arguments = small(&["generate", "beech", "--maps", "none"]);
    let mut command = venation(folder.path(), &arguments);
    assert!(command.arg("-o").arg(named(b"")).output().unwrap().status.success());
    assert!(folder.path().join(named(b"")).is_dir());
}

#[test]
fn more_threads_than_any_machine_has_are_refused() {
    let folder = fresh();
    let message = fail(folder.path(), 2, &small(&["generate", "beech", "-t", "100000"]));
    assert!(
        message.contains("--threads <N>': it takes a whole number from 1 to 1024"),
        "{message}"
    );
    assert!(contents(folder.path()).is_empty());
}

#[test]
fn two_outputs_are_not_written_into_one_file() {
    let folder = fresh();
    let bench = ["bench", "--auxins", "100", "--csv", "b", "--json", "b"];
    let compare = small(&["compare", "lilac", "-o", "c.png", "--csv", "c.png"]);
    for arguments in [&bench[..], &compare] {
        let message = fail(folder.path(), 2, arguments);
        assert!(message.contains("two outputs cannot be one file"), "{message}");
    }
    assert!(contents(folder.path()).is_empty());
}

#[test]
fn messages_stay_on_one_line_and_send_the_terminal_no_codes() {
    let folder = fresh();
    for arguments in
        [&["generate", "a\nb\u{1b}[31m"][..], &["generate", "beech", "--set", "name=a\nb"]]
    {
        let message = fail(folder.path(), 2, arguments);
        assert_eq!(message.lines().count(), 1, "{message}");
        assert!(!message.contains('\u{1b}'), "{message:?}");
    }
}
