use serde_json::{Value, json};
use tempfile::TempDir;

use crate::testing::{Bench, objection};
use armctl_frame::failure::{Failure, Kind};

/// The program in the sample session of the manual (TO 3-1), and its point.
const SAMPLE: &str = "SPD V=5\nMOVP a PT=1 CN=0 S V=0 POST\nOUT STN=0 PN1=.......1\nEND\n";
const POINTS: &str = "name,x_mm,y_mm,z_mm,r_mm\n1,100,20,0,0\n";

/// A folder with program files.
struct Workspace {
    folder: TempDir,
}

impl Workspace {
    fn new(files: &[(&str, &str)]) -> Self {
        let folder = tempfile::tempdir().unwrap();
        for (name, text) in files {
            std::fs::write(folder.path().join(name), text).unwrap();
        }
        Self { folder }
    }

    /// Runs `toyo sim run`. `./` in a word is replaced by the folder.
    fn run(&self, words: &[&str]) -> Result<(Value, Option<Failure>), Failure> {
        let folder = format!("{}/", self.folder.path().display());
        let words: Vec<String> = words.iter().map(|word| word.replace("./", &folder)).collect();
        let words: Vec<&str> = ["sim", "run"].into_iter().chain(words.iter().map(String::as_str)).collect();
        Bench::new("sim:").run(&words)
    }

    #[track_caller]
    fn data(&self, words: &[&str]) -> Value {
        match self.run(words) {
            Ok((data, None)) => data,
            other => panic!("{other:?}"),
        }
    }

    #[track_caller]
    fn failure(&self, words: &[&str]) -> Failure {
        match self.run(words) {
            Ok((_, Some(failure))) | Err(failure) => failure,
            other => panic!("{other:?}"),
        }
    }
}

/// Returns the texts of the events.
fn words(data: &Value) -> Vec<&str> {
    data["trace"].as_array().unwrap().iter().map(|row| row["what"].as_str().unwrap()).collect()
}

#[test]
fn the_sample_program_ends_at_its_position_with_its_output_on() {
    let workspace = Workspace::new(&[("a.txt", SAMPLE), ("points.csv", POINTS)]);
    let data = workspace.data(&["./a.txt", "--points", "./points.csv"]);
    assert_eq!(data["end"], "ended");
    assert_eq!(data["position"], json!({ "x_mm": 100.0, "y_mm": 20.0, "z_mm": 0.0, "r_mm": 0.0 }));
    assert_eq!(data["outputs"], json!([{ "station": 0, "port": 1, "bits": "00000001" }]));
    assert_eq!(
        words(&data),
        [
            "SPD V=05",
            "MOVP a PT=001 CN=00 S V=00 POST",
            "OUT STN=0 PN01=.......1",
            "output 0/01 = 00000001",
            "END",
            "task 1 has ended"
        ]
    );
}

#[test]
fn the_trace_shows_steps_with_line_and_label() {
    let workspace = Workspace::new(&[("a.txt", "# A comment.\n\nnext: CNT+ CN1=1\nJMPC TAG=next CN1<2\nEND\n")]);
    let data = workspace.data(&["./a.txt"]);
    assert_eq!(words(&data)[..3], ["next: TAG TAG=001", "CNT+ CN01=0001", "JMPC TAG=001 CN01< 0002 (next)"]);
    let at = &data["trace"][2]["at"];
    assert_eq!((&at["line"], &at["step"], &at["label"]), (&4.into(), &3.into(), &"next".into()));
}

#[test]
fn inputs_change_at_their_times() {
    let workspace = Workspace::new(&[("a.txt", "IN STN=0 PN1=.....1.. AND\nEND\n")]);
    let data = workspace.data(&["./a.txt", "--input", "at 2s 0/01/3 on"]);
    assert_eq!(words(&data), ["IN STN=0 PN01=.....1.. AND", "input 0/01/3 on", "END", "task 1 has ended"]);
    assert_eq!((&data["trace"][1]["time_s"], &data["trace"][2]["time_s"]), (&2.0.into(), &2.0.into()));
    assert_eq!(words(&workspace.data(&["./a.txt", "--input", "0/01 00000100"])).len(), 4);
    assert!(objection(&["sim", "run", "a.txt", "--input", "at 2s 0/01/9 on"]).contains("a number from 1 to 8"));
    assert!(objection(&["sim", "run", "a.txt", "--input", "at soon 0/01/1 on"]).contains("is not a valid duration"));
}

#[test]
fn a_program_that_waits_forever_is_reported_with_its_step() {
    let workspace = Workspace::new(&[("a.txt", "NOP\nIN STN=0 PN1=.....1.. AND\nEND\n")]);
    let failure = workspace.failure(&["./a.txt"]);
    assert_eq!(failure.kind, Kind::ConditionNotMet);
    let (message, hint) = (failure.message, failure.hint.unwrap());
    assert!(message.contains("all tasks wait for an input without end: "), "{message}");
    assert!(message.ends_with("a.txt:2, task 1, step 2: IN STN=0 PN01=.....1.. AND"), "{message}");
    assert_eq!(hint, "set the input with --input \"at 2s 0/01/3 on\"");
}

#[test]
fn an_error_is_reported_with_code_and_step() {
    let workspace = Workspace::new(&[("a.txt", "NOP\nMOV a X=8000 Y=0 Z=0 R=0 S V=1 POST\nEND\n")]);
    let (data, failure) = workspace.run(&["./a.txt"]).unwrap();
    let failure = failure.unwrap();
    assert_eq!((data["alarm"]["code"].as_str(), failure.code.as_deref()), (Some("C0"), Some("C0")));
    assert_eq!(failure.kind, Kind::ConditionNotMet);
    assert!(failure.message.contains("a.txt:2, task 1, step 2: MOV a X=+8000.00"), "{}", failure.message);
}

#[test]
fn the_run_ends_at_its_time_limit() {
    let workspace = Workspace::new(&[("a.txt", "a: JMP TAG=a\n")]);
    let (data, failure) = workspace.run(&["./a.txt", "--for", "2s", "--rows", "3"]).unwrap();
    assert_eq!(
        (&data["end"], &data["elapsed_s"], &data["rows_left_out"]),
        (&"time_up".into(), &2.0.into(), &1998.into())
    );
    assert!(failure.unwrap().message.starts_with("after 2.000 s, the program still runs: "));
}

#[test]
fn positions_are_sampled() {
    let workspace = Workspace::new(&[("a.txt", SAMPLE), ("points.csv", POINTS)]);
    let data = workspace.data(&["./a.txt", "--points", "./points.csv", "--trace-every", "200ms"]);
    let rows = data["trace"].as_array().unwrap();
    let places: Vec<f64> =
        rows.iter().filter(|row| row["event"] == "position").map(|row| row["x_mm"].as_f64().unwrap()).collect();
    assert_eq!(places.len(), 4);
    assert!(places.is_sorted() && places[0] == 0.0 && places[3] > 90.0, "{places:?}");
}

#[test]
fn parameters_and_other_tasks_come_from_files() {
    let workspace = Workspace::new(&[
        ("a.txt", "TSTR TASK=2\nIN STN=0 PN1=.......1 AND\nMOVP a PT=1 CN=0 S V=5 POST\nEND\n"),
        ("b.txt", "OUT STN=0 PN2=1.......\nEND\n"),
        ("points.csv", POINTS),
        ("more.csv", "name,x_mm,y_mm,z_mm,r_mm\n1,1,2,3,4\n"),
        ("params.csv", "name,value\nT2.5,10\n"),
    ]);
    let words_of = ["./a.txt", "--task", "2=./b.txt", "--points", "./points.csv", "--points", "2=./more.csv"];
    let words_of = [&words_of[..], &["--params", "./params.csv"]].concat();
    let data = workspace.data(&[&words_of[..], &["--input", "at 1s 0/01/1 on"]].concat());
    assert_eq!(data["outputs"][0]["bits"], "10000000");
    assert!(data["elapsed_s"].as_f64().unwrap() > 10.0, "100 mm at 10 mm/s");
}

#[test]
fn faulty_files_are_wrong_arguments() {
    let workspace = Workspace::new(&[
        ("a.txt", "EMD\n"),
        ("good.txt", "END\n"),
        ("points.csv", "name,x_mm\n1,0\n"),
        ("params.csv", "name,value\nT2.5,0\n"),
        ("state.toml", "axes = 9\n"),
    ]);
    for (words, message) in [
        (&["./a.txt"][..], "a.txt:1:1: unknown instruction 'EMD'"),
        (&["./good.txt", "--points", "./points.csv"], "points.csv: point 1: values are missing"),
        (&["./good.txt", "--params", "./params.csv"], "params.csv:2:1: T2.5: speed: 0.0 is out of range"),
        (&["./good.txt", "--state", "./state.toml"], "state.toml: line 1: axes must be from 1 to 4"),
    ] {
        let failure = workspace.failure(words);
        assert_eq!(failure.kind, Kind::Usage);
        assert!(failure.message.contains(message), "{}", failure.message);
    }
    assert_eq!(workspace.failure(&["./nothing.txt"]).kind, Kind::Local);
}
