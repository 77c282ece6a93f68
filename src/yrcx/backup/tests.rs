use tempfile::TempDir;

use crate::prelude::*;
use crate::testing::{frames, quiet, resolved, risk, words};
use armctl_frame::Family as _;
use armctl_frame::testing::{self, context, unlimited_access};

/// Simulated controller for several command lines in virtual time, with a folder for backups.
struct Workspace {
    folder: TempDir,
    runtime: tokio::runtime::Runtime,
    robot: Robot,
    link: Link,
}

impl Workspace {
    /// Controller in the built-in start state, or in this state.
    fn new(state: &str) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let runtime = tokio::runtime::Builder::new_current_thread().enable_time().start_paused(true).build().unwrap();
        let target = if state.is_empty() {
            "sim:".to_owned()
        } else {
            let file = folder.path().join("state.toml");
            std::fs::write(&file, state).unwrap();
            format!("sim:?state={}", file.display())
        };
        let (robot, _) = resolved(&target, &["status"]).unwrap();
        let access = unlimited_access();
        let link = runtime.block_on(Yrcx::connect(&robot, access, &quiet())).unwrap();
        Self { folder, runtime, robot, link }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// Runs a command line. `@` in the line is replaced by the folder.
    fn run(&mut self, line: &str) -> Result<(Value, Option<Failure>)> {
        let line = line.replace('@', self.folder.path().to_str().unwrap());
        let (_, command) = resolved("sim:", &line.split(' ').collect::<Vec<_>>())?;
        let Self { runtime, robot, link, .. } = self;
        let report = runtime.block_on(testing::run::<Yrcx>(&*command, context(robot, link)))?;
        Ok((report.data()?, report.failure()))
    }

    #[track_caller]
    fn data(&mut self, line: &str) -> Value {
        let (data, failure) = self.run(line).unwrap();
        assert_eq!(failure, None, "{data}");
        data
    }

    #[track_caller]
    fn failure(&mut self, line: &str) -> Failure {
        match self.run(line) {
            Ok((_, Some(failure))) | Err(failure) => failure,
            Ok((data, None)) => panic!("{data}"),
        }
    }

    /// Runs a command line for the time `after`, then drops it.
    fn run_and_drop(&mut self, line: &str, after: Duration) {
        let line = line.replace('@', self.folder.path().to_str().unwrap());
        let (_, command) = resolved("sim:", &line.split(' ').collect::<Vec<_>>()).unwrap();
        let Self { runtime, robot, link, .. } = self;
        let run = testing::run::<Yrcx>(&*command, context(robot, link));
        runtime.block_on(async { tokio::time::timeout(after, run).await.map(|_| ()).unwrap_err() });
        runtime.block_on(Yrcx::halt(link)).unwrap();
    }
}

/// Files of a folder, without the manifest.
fn files(folder: &Path) -> BTreeMap<String, String> {
    let named = |path: PathBuf| {
        let name = path.file_name().unwrap().to_str().unwrap().to_owned();
        (name, std::fs::read_to_string(path).unwrap())
    };
    let mut files: BTreeMap<_, _> =
        std::fs::read_dir(folder).unwrap().map(|entry| named(entry.unwrap().path())).collect();
    files.remove("manifest.json").unwrap();
    files
}

fn manifest(folder: &Path) -> Value {
    serde_json::from_str(&std::fs::read_to_string(folder.join("manifest.json")).unwrap()).unwrap()
}

fn item<'d>(data: &'d Value, name: &str) -> &'d Value {
    data["files"].as_array().unwrap().iter().find(|item| item["name"] == name).unwrap()
}

/// Lines that change every part.
const CHANGES: [&str; 10] = [
    "point set 19 --pulse 1,2,3,4",
    "point set 50 --mm 1,2,3,4 --hand left",
    "comment set 50 OTHER",
    "pallet-data set 2 2 2 1 110",
    "shift-data set 4 1 2 3 4",
    "hand-data set 1 2 1 2 3 0",
    "var set SGI5 5",
    "var set SGR5 0.1",
    "param set TOLE.3 99",
    "speed auto 55",
];

#[test]
fn restores_the_saved_data() {
    let mut workspace = Workspace::new("");
    let data = workspace.data("backup @/first");
    let done = data["files"].as_array().unwrap().iter().filter(|file| file["ok"] == true).count();
    assert_eq!((&data["complete"], done), (&json!(true), 14));
    let first = files(&workspace.path("first"));
    assert_eq!(first["pallets.csv"], "name,nx,ny,nz,first_point\n1,5,5,1,110\n2,10,15,1,110\n10,10,15,1,110\n");
    let points = &first["points-00000.csv"];
    assert!(points.contains("\n0,pulse,0,0,0,0,,\n1,mm,100.000,100.000,0.000,0.000,none,\n"), "{points}");
    assert!(points.contains("\n50,mm,10.000,-20.000,5.000,-18.000,none,WAIT ORG\n"), "{points}");
    assert!(
        first["parameters-2.csv"].starts_with("name,value\n") && first["parameters-2.csv"].contains("\nTOLE.3,80\n")
    );
    assert!(!first["parameters-3.csv"].contains("TOLE.3"), "robot 3 has two axes");
    assert_eq!(first["settings-1.csv"].lines().last(), Some("hand_system,right"));
    for line in CHANGES {
        workspace.data(line);
    }
    workspace.data("backup @/changed");
    let changed = files(&workspace.path("changed"));
    let differing: Vec<&str> = first.keys().filter(|name| first[*name] != changed[*name]).map(String::as_str).collect();
    assert_eq!(
        differing,
        [
            "hands.csv",
            "pallets.csv",
            "parameters-1.csv",
            "points-00000.csv",
            "settings-1.csv",
            "shifts.csv",
            "variables.csv"
        ]
    );
    let restored = workspace.data("restore @/first");
    for (name, written) in [("points-00000", 2), ("pallets", 1), ("shifts", 1), ("hands", 1), ("variables", 2)] {
        assert_eq!(item(&restored, name)["written"], written, "{name}");
    }
    assert!(restored["files"].as_array().unwrap().iter().all(|item| item["name"] != "parameters-1"));
    let restored = workspace.data("restore @/first --machine --only parameters,settings");
    assert_eq!(restored["files"].as_array().unwrap().len(), 8);
    let written = |name: &str| item(&restored, name)["written"].clone();
    assert_eq!((written("parameters-1"), written("settings-1")), (json!(1), json!(1)));
    workspace.data("backup @/second");
    assert_eq!(files(&workspace.path("second")), first);
    // Equal values are not written again.
    let again = workspace.data("restore @/first --machine");
    assert!(again["files"].as_array().unwrap().iter().all(|item| item["written"] == 0), "{again}");
}

#[test]
fn resumes_an_interrupted_backup() {
    let mut workspace = Workspace::new("");
    workspace.run_and_drop("backup @/cut", Duration::from_secs(4));
    let list = manifest(&workspace.path("cut"));
    let saved = list["files"].as_array().unwrap().len();
    assert!(saved > 2 && saved < 14 && list["complete"] == false, "{saved}");
    let failure = workspace.failure("backup @/cut");
    assert!(failure.message.contains("contains an incomplete backup"), "{failure}");
    let other = workspace.failure("backup @/cut --resume --points 0..9");
    assert_eq!(other.kind, Kind::Usage, "{other}");
    let data = workspace.data("backup @/cut --resume");
    assert_eq!((&data["complete"], &item(&data, "info")["state"]), (&json!(true), &json!("kept")));
    workspace.data("backup @/whole");
    assert_eq!(files(&workspace.path("cut")), files(&workspace.path("whole")));
    // A file that changed after the backup is read again from the controller.
    std::fs::write(workspace.path("cut/variables.csv"), "x").unwrap();
    let data = workspace.data("backup @/cut --resume");
    assert_eq!((&item(&data, "variables")["state"], &item(&data, "hands")["state"]), (&json!("done"), &json!("kept")));
}

#[test]
fn point_search_ends_at_a_gap_except_for_named_and_pallet_points() {
    let state = "stock = false\n[[robot]]\n[points]\n7 = { pulse = [1, 2, 3, 4] }\n300 = { pulse = [1, 2, 3, 4] }\n\
                 1100 = { pulse = [1, 2, 3, 4] }\n[pallets]\n3 = { counts = [2, 2, 1], first = 1099 }\n";
    let mut workspace = Workspace::new(state);
    let data = workspace.data("backup @/usual");
    assert_eq!(item(&data, "points-00000")["notes"], json!(["1 defined in 0..107"]));
    assert_eq!(item(&data, "points-01000")["notes"], json!(["1 defined in 1099..1103"]));
    let list = manifest(&workspace.path("usual"));
    assert_eq!(item(&list, "points-00000")["holds"], "points 0..107");
    assert_eq!(item(&list, "points-00000")["left_out"][0]["key"], "0..6, 8..107");
    workspace.data("backup @/named --points 299..301 --only points*");
    assert_eq!(manifest(&workspace.path("named"))["scope"], json!(["points 299..301", "only points*"]));
    assert!(files(&workspace.path("named"))["points-00000.csv"].ends_with("\n300,pulse,1,2,3,4,\n"));
    // `--resume` uses the selection of the earlier run.
    std::fs::remove_file(workspace.path("named/points-00000.csv")).unwrap();
    workspace.data("backup @/named --resume");
    assert_eq!(files(&workspace.path("named")).len(), 1);
}

#[test]
fn does_not_restore_a_modified_folder() {
    let mut workspace = Workspace::new("");
    workspace.data("backup @/saved");
    let points = workspace.path("saved/points-00000.csv");
    let text = std::fs::read_to_string(&points).unwrap();
    std::fs::write(&points, text.replace("150.000", "151.000")).unwrap();
    let failure = workspace.failure("restore @/saved");
    assert!(failure.message.ends_with("content changed (SHA-256)"), "{failure}");
    let dry = frames(&["restore", workspace.path("saved").to_str().unwrap(), "--force"]).unwrap_err();
    assert_eq!(dry.kind, Kind::Local, "a dry run says so as well");
    workspace.data("restore @/saved --only shifts");
    assert_eq!(workspace.failure("restore @/saved --only shift").kind, Kind::Usage);
    assert_eq!(workspace.failure("restore @/nowhere").kind, Kind::Local);
    assert_eq!(workspace.failure("restore @/saved --only settings").kind, Kind::Usage, "--machine is missing");
}

#[test]
fn reports_refused_parts_and_continues() {
    let mut workspace = Workspace::new("");
    workspace.data("backup @/saved");
    let mut other = Workspace::new("stock = false\n[[robot]]\nkind = \"scara\"\nmax_payload_g = 10\npayload_g = 0\n");
    let saved = workspace.path("saved");
    let other_robot = other.failure(&format!("restore {}", saved.display()));
    assert_eq!(other_robot.kind, Kind::Rejected, "{other_robot}");
    let (data, failure) = other.run(&format!("restore {} --force --machine", saved.display())).unwrap();
    let failure = failure.unwrap();
    assert_eq!(failure.kind, Kind::Mixed);
    assert!(failure.message.contains("settings-2: "), "{failure}");
    let parameters = item(&data, "parameters-2");
    assert_eq!((&parameters["state"], &item(&data, "points-00000")["written"]), (&json!("failed"), &json!(13)));
    assert!(parameters["left_out"].as_array().unwrap().len() > 3, "{parameters}");
}

#[test]
fn nothing_is_written_while_the_program_runs() {
    let mut workspace = Workspace::new("");
    workspace.data("backup @/saved --only variables");
    workspace.data("run");
    let failure = workspace.failure("restore @/saved");
    assert_eq!(failure.kind, Kind::Rejected);
    assert_eq!(failure.message, "the robot program is running, and may use the data that the restore writes");
}

#[test]
fn dry_runs_show_what_would_be_read_and_written() {
    let mut workspace = Workspace::new("");
    let sent = words(&["backup", workspace.path("new").to_str().unwrap()]).unwrap();
    assert_eq!((sent[0][0].as_str(), sent.last().unwrap()[0].as_str()), ("0x0501", "0x0101"));
    assert!(!workspace.path("new").exists());
    workspace.data("backup @/saved --only pallets");
    let sent = frames(&["restore", workspace.path("saved").to_str().unwrap(), "--force"]).unwrap();
    // All reads come before the first write.
    let last: Vec<_> = sent[sent.len() - 6..].iter().map(|frame| (&frame["about"], &frame["wi"][0])).collect();
    assert_eq!(last[2], (&json!("pallet 10"), &json!("0x0109")));
    assert_eq!(last[5], (&json!("pallet 10"), &json!("0x0108")));
    assert_eq!(sent.last().unwrap()["depends_on"], "the current data: written if different");
    assert_eq!((risk(&["backup", "x"]), risk(&["restore", "x"])), (Risk::Read, Risk::Destroy));
    assert_eq!(words(&["backup", "x", "--unit", "2"]).unwrap_err().kind, Kind::Usage);
}
