use std::sync::LazyLock;

use serde_json::Value;
use tempfile::TempDir;

use crate::prelude::basics::*;
use crate::testing::{Bench, Fault, blocks};

/// A controller with some content in each part, and a small memory.
const FULL: &str = r#"
axes = 2
points = { 1 = { 1 = [100.0, 20.0, 0.0, 0.0], 999 = [-1.5, 0.0, 0.0, 0.0] } }
steps = { 1 = ["TAG TAG=001", "SPD V=05", "JMP TAG=001"], 2 = ["OUT STN=0 PN01=.......1", "END"] }
write = ["WPAR M09 J", "WPAR T2 V05=0250.0", "WPLT 03 SNO=01 TAG=007 MOD=M-M",
         "WPAR E22 TASK01=0010 TASK02=0005 TASK03=0000 TASK04=0000",
         "WESY PNO=02 ST=000 START=010 LOOP=0005 END=020"]
"#;
/// The same controller without content.
const EMPTY: &str = "axes = 2\nwrite = [\"WPAR E22 TASK01=0010 TASK02=0005 TASK03=0000 TASK04=0000\"]\n";

/// The files of a backup of [`FULL`]. The backup takes some time, so it is made only once.
static SAVED: LazyLock<BTreeMap<String, String>> = LazyLock::new(|| {
    let folder = tempfile::tempdir().unwrap();
    controller(FULL).data(&["backup", folder.path().to_str().unwrap()]);
    files(folder.path())
});

/// A folder for backups.
struct Workspace {
    folder: TempDir,
}

impl Workspace {
    fn new() -> Self {
        Self { folder: tempfile::tempdir().unwrap() }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// Writes the backup of [`FULL`] to the folder.
    fn saved(&self) -> String {
        let folder = self.path("saved");
        std::fs::create_dir(&folder).unwrap();
        for (name, text) in SAVED.iter() {
            std::fs::write(folder.join(name), text).unwrap();
        }
        folder.to_str().unwrap().to_owned()
    }
}

fn controller(state: &str) -> Bench {
    Bench::with_faults(state, |_, _| Fault::None).0
}

/// The files of a folder.
fn files(folder: impl AsRef<Path>) -> BTreeMap<String, String> {
    let named = |path: PathBuf| {
        let name = path.file_name().unwrap().to_str().unwrap().to_owned();
        (name, std::fs::read_to_string(path).unwrap())
    };
    std::fs::read_dir(folder).unwrap().map(|entry| named(entry.unwrap().path())).collect()
}

fn part<'d>(data: &'d Value, name: &str) -> &'d Value {
    data["files"].as_array().unwrap().iter().find(|part| part["name"] == name).unwrap()
}

fn failure(bench: &mut Bench, words: &[&str]) -> Failure {
    match bench.run(words) {
        Ok((_, Some(failure))) | Err(failure) => failure,
        Ok((data, None)) => panic!("{data}"),
    }
}

#[test]
fn a_backup_holds_all_that_is_stored() {
    let list: Value = serde_json::from_str(&SAVED["manifest.json"]).unwrap();
    assert_eq!((&list["complete"], &list["controller"]["task_axes"]), (&true.into(), &"2000".into()));
    let files = &*SAVED;
    let names: Vec<&str> = files.keys().map(String::as_str).filter(|name| !name.starts_with("palletizing")).collect();
    assert_eq!(
        names,
        ["easy.csv", "manifest.json", "parameters.csv", "points-1.csv", "program-1.txt", "program-2.txt"]
    );
    assert_eq!(files.len(), 22);
    assert!(files["points-1.csv"].starts_with("name,x_mm,y_mm,z_mm,r_mm\n1,100.00,20.00,0.00,0.00\n"));
    assert!(files["points-1.csv"].ends_with("\n999,-1.50,0.00,0.00,0.00\n"));
    assert!(files["program-1.txt"].starts_with("TAG TAG=001\nSPD V=05\nJMP TAG=001"));
    assert!(files["program-2.txt"].starts_with("OUT STN=0 PN01=.......1\nEND\n# 3 NOP"));
    assert!(
        files["parameters.csv"].contains("\npendant-language,J\n")
            && files["parameters.csv"].contains("\nT2.5,250.0\n")
    );
    assert!(files["palletizing-03.csv"].contains("\nstart,tag=7 mode=M-M\n"));
    assert!(files["easy.csv"].contains("\n2,10,5,20\n"));
}

#[test]
fn restores_the_saved_data() {
    let workspace = Workspace::new();
    let first = workspace.saved();
    let mut bench = controller(EMPTY);
    let restored = bench.data(&["restore", &first]);
    let written = |data: &Value, name: &str| part(data, name)["written"].clone();
    assert_eq!(written(&restored, "points-1"), 2);
    assert_eq!(written(&restored, "program-1"), 3);
    assert_eq!(written(&restored, "program-2"), 2);
    assert_eq!(written(&restored, "palletizing-03"), 1);
    assert_eq!(written(&restored, "palletizing-04"), 0);
    assert_eq!(written(&restored, "override"), 0);
    assert_eq!((written(&restored, "parameters"), written(&restored, "easy")), (2.into(), 1.into()));
    let status = bench.data(&["status"]);
    assert_eq!(status["mode"], "automatic", "the mode is as it was found");
    assert_eq!(bench.data(&["task", "get"])["task"], 1);
    let second = workspace.path("second");
    bench.data(&["backup", second.to_str().unwrap()]);
    let (mut first, mut second) = (files(first), files(second));
    assert_ne!(first.remove("manifest.json"), second.remove("manifest.json"), "the time is another one");
    assert_eq!(first, second);
}

#[test]
fn does_not_write_equal_data() {
    let workspace = Workspace::new();
    let folder = workspace.saved();
    let restored = controller(FULL).data(&["restore", &folder]);
    for part in restored["files"].as_array().unwrap() {
        assert_eq!((&part["state"], &part["written"]), (&"done".into(), &0.into()), "{part}");
    }
}

#[test]
fn resumes_an_interrupted_backup() {
    let workspace = Workspace::new();
    let folder = workspace.path("saved");
    let folder = folder.to_str().unwrap();
    let silent = |block: &str, _| if block == "@RPLT 05 SNO=07" { Fault::Lost } else { Fault::None };
    let (mut bench, _) = Bench::with_faults(FULL, silent);
    let (data, failed) = bench.run(&["backup", folder]).unwrap();
    let failed = failed.unwrap();
    assert_eq!((failed.kind, &data["complete"]), (Kind::Mixed, &false.into()));
    assert!(failed.message.starts_with("1 of 21 failed, 14 not tried: palletizing-05: "), "{}", failed.message);
    assert!(failed.hint.unwrap().ends_with("use --resume to read the missing parts"));
    assert_eq!(failure(&mut controller(FULL), &["backup", folder]).kind, Kind::Local);
    let (mut bench, heard) = Bench::with_faults(FULL, |_, _| Fault::None);
    let data = bench.data(&["backup", folder, "--resume"]);
    assert_eq!(data["complete"], true);
    assert_eq!(
        (&part(&data, "parameters")["state"], &part(&data, "palletizing-05")["state"]),
        (&"kept".into(), &"done".into())
    );
    assert!(!heard.borrow().iter().any(|block| block == "@RPLT 04 SNO=01"), "what is there is not read again");
}

#[test]
fn reports_refused_parts_and_continues() {
    let workspace = Workspace::new();
    let folder = workspace.path("saved");
    let folder = folder.to_str().unwrap();
    let refuse = |block: &str, _| if block.starts_with("@RESY") { Fault::Answered("@NG") } else { Fault::None };
    let (mut bench, _) = Bench::with_faults(FULL, refuse);
    let (data, failed) = bench.run(&["backup", folder]).unwrap();
    assert_eq!((failed.unwrap().kind, &part(&data, "program-2")["state"]), (Kind::Mixed, &"done".into()));
    let list = std::fs::read_to_string(workspace.path("saved/manifest.json")).unwrap();
    let list: Value = serde_json::from_str(&list).unwrap();
    assert!(list["files"][1]["error"]["message"].as_str().unwrap().contains("@NG"));
}

#[test]
fn a_changed_file_is_not_sent() {
    let workspace = Workspace::new();
    let folder = workspace.saved();
    std::fs::write(workspace.path("saved/points-1.csv"), "point,x_mm,y_mm,z_mm,r_mm\n").unwrap();
    let (mut bench, heard) = Bench::with_faults(FULL, |_, _| Fault::None);
    assert_eq!(failure(&mut bench, &["restore", &folder]).kind, Kind::Local);
    assert_eq!(heard.borrow().len(), 0);
    bench.data(&["restore", &folder, "--only", "easy"]);
}

#[test]
fn another_robot_is_refused() {
    let workspace = Workspace::new();
    let folder = workspace.saved();
    let mut other = controller(&format!("robot_types = [7]\n{EMPTY}"));
    let failed = failure(&mut other, &["restore", &folder]);
    assert_eq!(failed.kind, Kind::Rejected);
    assert_eq!(
        failed.message,
        "the backup is from another machine: robot type is 000000 in the backup and 000007 on this controller"
    );
    other.data(&["restore", &folder, "--force", "--only", "program"]);
}

#[test]
fn a_program_must_have_room_before_anything_is_written() {
    let workspace = Workspace::new();
    let folder = workspace.saved();
    let (mut bench, heard) = Bench::with_faults("axes = 2", |_, _| Fault::None);
    let failed = failure(&mut bench, &["restore", &folder]);
    assert_eq!((failed.kind, failed.message.as_str()), (Kind::Usage, "program-2 needs 2 steps, but task 2 has 0"));
    assert!(!heard.borrow().iter().any(|block| block.starts_with("@W")));
}

#[test]
fn machine_parameters_come_first_and_alone() {
    let workspace = Workspace::new();
    let folder = workspace.saved();
    let (mut bench, heard) = Bench::with_faults("axes = 2", |_, _| Fault::None);
    let (data, failed) = bench.run(&["restore", &folder, "--machine"]).unwrap();
    assert_eq!(failed.unwrap().kind, Kind::ConditionNotMet);
    assert_eq!((&data["needs_power_cycle"], &part(&data, "points-1")["state"]), (&true.into(), &"not_tried".into()));
    let written: Vec<String> = heard.borrow().iter().filter(|block| block.starts_with("@W")).cloned().collect();
    assert_eq!(written, ["@WPAR E22 TASK01=0010 TASK02=0005 TASK03=0000 TASK04=0000"]);
    // A value that is already equal is not a change.
    let data = controller(EMPTY).data(&["restore", &folder, "--machine"]);
    assert_eq!((&data["needs_power_cycle"], &part(&data, "points-1")["state"]), (&false.into(), &"done".into()));
}

#[test]
fn failed_restore_reports_its_progress() {
    let workspace = Workspace::new();
    let folder = workspace.saved();
    let lost = |block: &str, _| if block.starts_with("@WPLT 03") { Fault::Unanswered } else { Fault::None };
    let (mut bench, _) = Bench::with_faults(EMPTY, lost);
    let (data, failed) = bench.run(&["restore", &folder]).unwrap();
    let failed = failed.unwrap();
    assert_eq!(failed.kind, Kind::OutcomeUnknown);
    assert!(
        failed.message.contains("palletizing-03: ") && failed.message.contains("unknown: start"),
        "{}",
        failed.message
    );
    let state = |name: &str| part(&data, name)["state"].as_str().unwrap().to_owned();
    assert_eq!(
        (&*state("palletizing-02"), &*state("palletizing-04"), &*state("override")),
        ("done", "not_tried", "not_tried")
    );
    let mut bench = controller(EMPTY);
    let data = bench.data(&["restore", &folder, "--resume=palletizing-03"]);
    assert_eq!(data["files"][0]["name"], "palletizing-03");
}

#[test]
fn a_dry_run_shows_what_would_be_written() {
    let workspace = Workspace::new();
    let folder = workspace.saved();
    let blocks = blocks(&["restore", &folder, "--force", "--only", "program-2,easy"]).unwrap();
    assert!(blocks.contains(&"@WSTX 0001 OUT STN=0 PN01=.......1".to_owned()));
    assert!(blocks.contains(&"@WESY PNO=02 ST=000 START=010 LOOP=0005 END=020".to_owned()));
    assert!(!blocks.iter().any(|block| block.starts_with("@WPAR")));
}

#[test]
fn a_folder_with_other_files_is_left_alone() {
    let workspace = Workspace::new();
    std::fs::write(workspace.path("letter.txt"), "x").unwrap();
    let folder = workspace.folder.path().to_str().unwrap();
    for words in [["backup", folder], ["restore", folder]] {
        assert_eq!(blocks(&words).unwrap_err().kind, Kind::Local);
    }
    assert_eq!(blocks(&["restore", "/nowhere"]).unwrap_err().kind, Kind::Local);
}

#[test]
fn unlisted_value_does_not_prevent_a_backup() {
    let workspace = Workspace::new();
    let folder = workspace.path("odd");
    let folder = folder.to_str().unwrap();
    let odd = |block: &str, _| match block {
        "@RPAR M18" => Fault::Answered("@RPAR M18 STN=01 BRT=156K"),
        "@RSTX 0004" => Fault::Answered("@RSTX 0004 FOO X=1"),
        "@RPAR T1 PT=005" => Fault::Answered("@RPAR T1 PT=005 X=+1.5 Y=+0000.00 Z=+0000.00 R=+0000.00"),
        "@RPLT 03 SNO=01" => Fault::Answered("@RPLT 03 SNO=01 TAG=007 MOD=X-Y"),
        "@RESY PNO=02 ST=000" => Fault::Answered("@NG"),
        _ => Fault::None,
    };
    let (mut bench, _) = Bench::with_faults(FULL, odd);
    let data = bench.data(&["backup", folder]);
    assert_eq!(data["complete"], true);
    let keys = |name: &str| {
        let left = part(&data, name)["left_out"].as_array().unwrap().iter();
        left.map(|left| left["key"].as_str().unwrap().to_owned()).collect::<Vec<_>>()
    };
    for (name, key) in
        [("parameters", "devicenet"), ("program-1", "4"), ("points-1", "5"), ("palletizing-03", "start"), ("easy", "2")]
    {
        assert!(keys(name).contains(&key.to_owned()), "{name}: {:?}", keys(name));
    }
    let files = files(folder);
    assert!(files["program-1.txt"].contains("\nFOO X=1      # not in the manual\n"), "{}", files["program-1.txt"]);
    assert!(!files["points-1.csv"].contains("\n5,"));
    // The machine that already has this step gets the rest of the program back. On another machine, nothing of the
    // program is written.
    assert_eq!(part(&bench.data(&["restore", folder]), "program-1")["state"], "done");
    let (mut bench, heard) = Bench::with_faults(EMPTY, |_, _| Fault::None);
    let failed = failure(&mut bench, &["restore", folder]);
    assert_eq!(failed.kind, Kind::Mixed);
    assert!(
        failed.message.contains("step 4 is 'FOO X=1' in the backup, which is not in the manual and cannot be written"),
        "{failed}"
    );
    assert!(!heard.borrow().iter().any(|block| block.starts_with("@WSTX 0001") && !block.contains("OUT")));
}

#[test]
fn axes_of_another_machine_are_refused_before_anything_is_written() {
    let workspace = Workspace::new();
    let folder = workspace.saved();
    for (other, told) in [
        ("write = [\"WPAR E19 1100\"]\n", "E19 (task-axes) is 2000 in the backup and 1100 on this controller"),
        (
            "axes = 2\nwrite = [\"WPAR E01 AX1=X AX2=Z AX3=Y AX4=R\"]\n",
            "E01 (axis-letters) is X Y Z R in the backup and X Z Y R on this controller",
        ),
    ] {
        let (mut bench, heard) = Bench::with_faults(other, |_, _| Fault::None);
        let failed = failure(&mut bench, &["restore", &folder, "--only", "parameters"]);
        assert_eq!(
            (failed.kind, &*failed.message),
            (Kind::Rejected, &*format!("the backup is from another machine: {told}"))
        );
        assert!(!heard.borrow().iter().any(|block| block.starts_with("@W")));
        bench.data(&["restore", &folder, "--only", "parameters", "--force"]);
    }
    // Robot name and address must be equal to the name and address in the manifest, as with `armctl restore`.
    let failed = blocks(&["restore", &folder]).unwrap_err();
    assert_eq!(failed.kind, Kind::Rejected);
    assert!(failed.message.contains("the backup is from sim (sim:), not from tcp://127.0.0.1:1"), "{failed}");
}
