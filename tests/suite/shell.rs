//! What editors and shells are given: the schema, completions, the manual; and clean streams.

use regex_lite::Regex;
use serde_json::Value;
use venation::document::{Comments, schema};
use venation::presets::PRESETS;

use crate::support::{fail, fresh, run, small, succeed, venation};

/// What is wrong with a value under the part of JSON Schema that the schema uses; `None` when nothing.
fn problem(root: &Value, schema: &Value, value: &Value, at: &str) -> Option<String> {
    if let Some(target) = schema["$ref"].as_str() {
        return problem(root, root.pointer(target.trim_start_matches('#')).unwrap(), value, at);
    }
    if let Some(options) = schema["anyOf"].as_array() {
        let fits = options.iter().any(|option| problem(root, option, value, at).is_none());
        return (!fits).then(|| format!("{at}: {value} fits none of {options:?}"));
    }
    if let Some(words) = schema["enum"].as_array() {
        return (!words.contains(value)).then(|| format!("{at}: {value} is none of {words:?}"));
    }
    let fits = match schema["type"].as_str().expect("a type") {
        "object" => value.is_object(),
        "array" => value.is_array(),
        "string" => value.is_string(),
        "boolean" => value.is_boolean(),
        "integer" => value.as_f64().is_some_and(|x| x.fract() == 0.0),
        "number" => value.is_number(),
        other => panic!("{other}"),
    };
    if !fits {
        return Some(format!("{at}: {value} is no {}", schema["type"]));
    }
    if let (Some(min), Some(x)) = (schema["minimum"].as_f64(), value.as_f64())
        && x < min
    {
        return Some(format!("{at}: {x} is below {min}"));
    }
    if let (Some(max), Some(x)) = (schema["maximum"].as_f64(), value.as_f64())
        && x > max
    {
        return Some(format!("{at}: {x} is above {max}"));
    }
    if let (Some(pattern), Some(text)) = (schema["pattern"].as_str(), value.as_str()) {
        let fits = Regex::new(pattern).expect("an expression").is_match(text);
        return (!fits).then(|| format!("{at}: {text} is not as {pattern}"));
    }
    if let Some(items) = value.as_array() {
        let count = items.len() as u64;
        if schema["minItems"].as_u64().is_some_and(|min| count < min)
            || schema["maxItems"].as_u64().is_some_and(|max| count > max)
        {
            return Some(format!("{at}: {count} items"));
        }
        return items.iter().find_map(|item| problem(root, &schema["items"], item, at));
    }
    value.as_object()?.iter().find_map(|(key, value)| {
        let at = format!("{at}.{key}");
        let others = &schema["additionalProperties"];
        match schema.get("properties").and_then(|known| known.get(key)) {
            Some(schema) => problem(root, schema, value, &at),
            None if others.is_object() => problem(root, others, value, &at),
            None => Some(format!("{at}: unknown")),
        }
    })
}

fn check(toml: &str) -> Option<String> {
    let value: Value = toml::from_str(toml).expect("TOML");
    let schema = schema();
    problem(&schema, &schema, &value, "leaf")
}

#[test]
fn the_schema_takes_every_preset_and_refuses_what_the_program_refuses() {
    for preset in PRESETS {
        assert_eq!(check(preset.text), None, "{}", preset.name);
        let complete = preset.document().unwrap().to_toml(Comments::Full);
        assert_eq!(check(&complete), None, "{} in full", preset.name);
    }
    for (text, good) in [
        ("[margin]\nlength_mm = \"80 ± 25%\"\n", true),
        ("[margin]\nlength_mm = \"60..90\"\n", true),
        ("[growth]\ntotal_steps = [10, 12]\n", true),
        ("seed = 3\nversion = \"0.1.0\"\n", true),
        ("vary = 20\n", true),
        ("vary = \"12.5 %\"\n", true),
        ("vary = 150\n", false),
        ("[[margin.lobe]]\nangle_deg = 90\n[[margin.lobe]]\nside = \"apex\"\n", true),
        ("[[margin.lobe]]\nangel_deg = 90\n", false),
        ("[[margin.lobe]]\nangle_deg = 900\n", false),
        ("[veins]\nkill_distanse_mm = 2\n", false),
        ("[growth]\nscale = 3.0\n", false),
        ("[growth]\ntotal_steps = 2.5\n", false),
        ("[growth]\ntype = \"isotropc\"\n", false),
        ("[margin]\nlength_mm = [1, 2, 3]\n", false),
        ("seed = -1\n", false),
        ("[margin]\nlength_mm = \"wide\"\n", false),
        ("vary = \"some\"\n", false),
        ("[output]\nbits = 16\n", true),
        ("[output]\nbits = 12\n", false),
        ("[output]\nbits = [8, 16]\n", false),
        ("[output]\nbits = \"8..16\"\n", false),
    ] {
        assert_eq!(check(text).is_none(), good, "{text}: {:?}", check(text));
        let document = venation::document::Document::parse(text, "leaf.toml");
        assert_eq!(document.is_ok(), good, "{text}");
    }
}

#[test]
fn the_schema_knows_which_texts_the_program_takes() {
    let folder = fresh();
    let (long, longer) = ("x".repeat(100), "x".repeat(101));
    for (key, text, good) in [
        ("name", "Acer_2-b", true),
        ("name", &long, true),
        ("name", &longer, false),
        ("name", "", false),
        ("name", "../up", false),
        ("name", "a b", false),
        ("name", "ahorn ä", false),
        ("title", "any: text, at all", true),
        ("output.maps", "default", true),
        ("output.maps", "none", true),
        ("output.maps", " All ", true),
        ("output.maps", "BaseColor, ao,default", true),
        ("output.maps", "none,basecolor", false),
        ("output.maps", "basecolor,all", false),
        ("output.maps", "basecolour", false),
        ("output.maps", "basecolor,", false),
        ("output.maps", "basecolor height", false),
        ("output.maps", "", false),
        ("output.formats", "obj", true),
        ("output.formats", "GLB , svg,graphml", true),
        ("output.formats", "None", true),
        ("output.formats", "obj,none", false),
        ("output.formats", "objx", false),
        ("output.formats", "default", false),
        ("output.formats", "", false),
    ] {
        let toml = format!("{key} = \"{text}\"\n");
        assert_eq!(check(&toml).is_none(), good, "{toml}: {:?}", check(&toml));
        std::fs::write(folder.path().join("leaf.toml"), &toml).unwrap();
        let (code, _, message) = run(folder.path(), &["generate", "leaf.toml", "-n"]);
        assert_eq!(code, if good { 0 } else { 2 }, "{toml}: {message}");
    }
}

#[test]
fn the_program_prints_the_schema() {
    let folder = fresh();
    let printed = succeed(folder.path(), &["schema"]);
    assert_eq!(serde_json::from_str::<Value>(&printed).unwrap(), schema());
}

#[test]
fn every_shell_gets_a_script_and_every_command_a_page() {
    let folder = fresh();
    let commands = ["generate", "atlas", "compare", "inspect", "bench", "presets", "merge"];
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let script = succeed(folder.path(), &["completions", shell]);
        for needed in commands.iter().chain(&["skip-existing", "profile"]) {
            assert!(script.contains(needed), "{shell}: {needed}");
        }
    }
    let page = succeed(folder.path(), &["man"]);
    assert!(page.contains(".TH venation 1"), "{page}");
    for command in commands {
        let page = succeed(folder.path(), &["man", command]);
        assert!(page.contains(&format!(".TH venation-{command} 1")), "{page}");
    }
    let message = fail(folder.path(), 2, &["man", "frobnicate"]);
    assert!(message.contains("generate"), "{message}");
    fail(folder.path(), 2, &["completions", "tcsh"]);
}

#[test]
fn no_colour_and_no_bar_reaches_what_is_no_terminal() {
    let folder = fresh();
    let commands: &[&[&str]] = &[
        &["--help"],
        &["generate", "--help"],
        &["generate", "beach"],
        &["generate", "beech", "--size", "64", "--seeds", "1-3", "-o", "a", "--maps", "none"],
        &["presets"],
    ];
    for arguments in commands {
        for colour in [("NO_COLOR", "1"), ("CLICOLOR_FORCE", "1")] {
            let mut command = venation(folder.path(), arguments);
            let output = command.env(colour.0, colour.1).output().unwrap();
            for stream in [&output.stdout, &output.stderr] {
                assert!(!stream.contains(&0x1b), "{arguments:?} under {}", colour.0);
                assert!(!stream.contains(&b'\r'), "{arguments:?}");
            }
        }
    }
}

#[test]
fn json_stands_alone_on_stdout_whatever_happens() {
    let folder = fresh();
    let base = ["generate", "grass", "--size", "64", "--maps", "basecolor", "--json", "-o", "out"];
    let with = |more: &[&'static str]| [&base[..], more].concat();
    for (arguments, code) in [
        (with(&["--dry-run"]), 0),
        (with(&["--seeds", "1-2"]), 0),
        (with(&["--seeds", "1-2", "--skip-existing"]), 0),
        (with(&["--seeds", "3-4", "--dry-run"]), 0),
    ] {
        let (got, stdout, stderr) = run(folder.path(), &arguments);
        assert_eq!(got, code, "{stderr}");
        let document: Value = serde_json::from_str(&stdout).unwrap();
        assert!(document["leaves"].is_array());
    }
    let (code, stdout, _) = run(folder.path(), &with(&["--seeds", "1-2"]));
    assert_eq!((code, stdout.as_str()), (3, ""));
}

#[cfg(target_os = "linux")]
#[test]
fn messages_that_cannot_be_written_stop_nothing() {
    let folder = fresh();
    let run = |arguments: &[&str]| {
        let full = std::fs::File::options().write(true).open("/dev/full").expect("a full device");
        std::process::Command::new(assert_cmd::cargo::cargo_bin("venation"))
            .current_dir(folder.path())
            .args(arguments)
            .stdout(std::process::Stdio::null())
            .stderr(full)
            .status()
            .expect("the program starts")
            .code()
    };
    assert_eq!(run(&["generate", "beach"]), Some(2));
    assert_eq!(run(&["merge", "nowhere"]), Some(2));
    std::fs::create_dir(folder.path().join("out")).unwrap();
    std::fs::write(folder.path().join("out/fagus-sylvatica_s0002"), "in the way").unwrap();
    let batch = small(&["generate", "beech", "--seeds", "1-2", "-o", "out"]);
    assert_eq!(run(&batch), Some(4));
    assert!(folder.path().join("out/manifest.jsonl").exists());
}
