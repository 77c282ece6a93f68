//! A simulator that starts from the backup of a robot holds what the backup holds.

use std::fmt::Write as _;
use std::io::{BufRead as _, BufReader};
use std::process::{Command, Stdio};

use serde_json::Value;

use crate::gate::workspace::{Workspace, result_of};

/// Random numbers for the content of controllers, the same in every run.
struct Random(u64);

impl Random {
    /// A number from `first` to `last`.
    fn number(&mut self, first: i64, last: i64) -> i64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        first + i64::try_from(self.0 >> 33).expect("31 bits") % (last - first + 1)
    }

    /// A number with two decimals.
    fn decimal(&mut self, first: i64, last: i64) -> String {
        format!("{}.{:02}", self.number(first, last - 1), self.number(0, 99))
    }
}

/// Start state of a random yerc controller.
fn yerc(random: &mut Random) -> String {
    let model = ["fs100", "dx100", "dx200", "yrc1000"][usize::try_from(random.number(0, 3)).expect("small")];
    let mut state = format!("model = \"{model}\"\n[variables]\n");
    for _ in 0..10 {
        writeln!(state, "B{} = {}", random.number(0, 49), random.number(0, 255)).expect("text grows");
        writeln!(state, "D{} = {}", random.number(50, 99), random.number(-70_000, 70_000)).expect("text grows");
    }
    // A key can occur only once.
    let mut lines: Vec<&str> = state.lines().collect();
    lines.sort_by_key(|line| line.split(" = ").next().map(str::to_owned));
    lines.dedup_by_key(|line| line.split(" = ").next().map(str::to_owned));
    lines.retain(|line| line.contains(" = ") && !line.starts_with("model"));
    let mut state = format!("model = \"{model}\"\n[variables]\n{}\n", lines.join("\n"));
    for number in 0..random.number(1, 4) {
        let steps: String =
            (0..random.number(1, 9)).map(|_| format!("SET B{:03} {}\n", 1, random.number(0, 9))).collect();
        write!(state, "[[file]]\nname = \"J{number}.JBI\"\ntext = \"\"\"\n/JOB\n//NAME J{number}\n//INST\nNOP\n{steps}END\n\"\"\"\n")
            .expect("text grows");
    }
    state
}

/// Start state of a random yrcx controller.
fn yrcx(random: &mut Random) -> String {
    let mut state = format!(
        "stock = false\n[variables]\nSGI{} = {}\n[[robot]]\naxes = {}\nauto_speed = {}\npayload_g = {}\n[points]\n",
        random.number(0, 31),
        random.number(-9, 9_999),
        random.number(1, 4),
        random.number(1, 100),
        random.number(0, 9_999),
    );
    for number in 0..5 {
        let places = [0; 4].map(|_| random.decimal(0, 400)).join(", ");
        writeln!(state, "{} = {{ mm = [{places}] }}", number * 9 + random.number(0, 8)).expect("text grows");
    }
    let pulses = random.number(-99_999, 99_999);
    write!(state, "50 = {{ pulse = [{pulses}, 0, 0, 1] }}\n[comments]\n50 = \"C{pulses}\"\n[shifts]\n")
        .expect("text grows");
    writeln!(state, "{} = [{}, 0.0, 0.0, 0.0]", random.number(1, 39), random.decimal(0, 99)).expect("text grows");
    write!(state, "[hands]\n{} = {{ robot = 1, data = [{pulses}, 1, 2, 0] }}\n", random.number(0, 31))
        .expect("text grows");
    state
}

/// Start state of a random toyo controller.
fn toyo(random: &mut Random) -> String {
    let model = ["KCA-20-M00", "KCA-25-M80", "other"][usize::try_from(random.number(0, 2)).expect("small")];
    let axes = random.number(2, 4);
    let mut state = format!("model = \"{model}\"\naxes = {axes}\nversion = \"3.{}\"\n", random.number(30, 40));
    writeln!(state, "speeds = {{ 5 = {}.0 }}", random.number(1, 300)).expect("text grows");
    let tags: String =
        (0..random.number(1, 9)).map(|_| format!("\"TAG TAG={:03}\", ", random.number(1, 999))).collect();
    writeln!(state, "steps = {{ 1 = [{tags}\"SPD V=05\", \"END\"] }}").expect("text grows");
    let place = random.decimal(0, 300);
    writeln!(state, "points = {{ 1 = {{ {} = [{place}, 1.0, 0.0, 0.0] }} }}", random.number(1, 999))
        .expect("text grows");
    writeln!(state, "write = [\"WESY PNO=01 ST=000 START=001 LOOP=0002 END=001\"]").expect("text grows");
    state
}

/// Checks that the backup of a twin equals the backup that the twin comes from.
fn check(family: &str, generate: impl Fn(&mut Random) -> String + Sync) {
    let check_one = &|seed| {
        let desk = Workspace::new("");
        let state = generate(&mut Random(seed));
        std::fs::write(desk.folder.path().join("state.toml"), &state).expect("it is written");
        for line in [
            format!("-t sim:?state=state.toml {family} backup first"),
            "-t sim:?from=first backup second".to_owned(),
            "diff first second --exact".to_owned(),
        ] {
            let came = desk.run(&line);
            assert_eq!(came.exit, Some(0), "{line}: {came:?}\n{state}");
        }
    };
    // A backup waits most of its time for its bus.
    std::thread::scope(|scope| {
        for seed in 1..=3 {
            scope.spawn(move || check_one(seed));
        }
    });
}

#[test]
fn yerc_twin_equals_its_backup() {
    check("yerc", yerc);
}

#[test]
fn yrcx_twin_equals_its_backup() {
    check("yrcx", yrcx);
}

#[test]
fn toyo_twin_equals_its_backup() {
    check("toyo", toyo);
}

#[test]
fn twin_has_the_values_of_an_edited_backup() {
    let desk = Workspace::new("");
    desk.data("--sim toyo backup press --only points");
    let file = desk.folder.path().join("press/points-1.csv");
    let text = std::fs::read_to_string(&file).expect("points");
    std::fs::write(&file, text.replace("\n7,0.00,", "\n7,12.50,")).expect("it is written");
    assert_eq!(desk.data("-t sim:?from=press toyo point get 7")["items"][0]["value"]["x_mm"], 12.5);
    std::fs::write(&file, text.replace("\n7,0.00,", "\n7,many,")).expect("it is written");
    desk.fails("-t sim:?from=press status", 2, "points-1.csv");
    desk.fails("-t sim:?from=nowhere toyo status", 1, "there is no folder nowhere");
    desk.fails("-t sim:?from=press yerc status", 2, "backup of a toyo controller");
    desk.fails("sim yrcx --from press", 2, "backup of a toyo controller");
}

#[test]
fn twin_has_the_model_of_its_backup() {
    let desk = Workspace::new("");
    desk.data("--sim yerc backup weld --only VAR.DAT");
    desk.data("-t sim:?from=weld&model=dx200 yerc var get B5");
    desk.fails("-t sim:?from=weld&model=fs100 yerc var get B5", 2, "the selected model is fs100");
}

#[test]
fn inventory_is_readable_without_the_backup_of_a_twin() {
    let desk = Workspace::new("");
    desk.data("--sim toyo backup press --only points");
    desk.data("robots add twin sim:?from=press");
    std::fs::remove_dir_all(desk.folder.path().join("press")).expect("it is removed");
    desk.data("robots list");
}

#[test]
fn twin_reads_the_numbers_of_a_real_variable_file() {
    let desk = Workspace::new("");
    desk.data("--sim yerc backup press");
    let file = desk.folder.path().join("press/VAR.DAT");
    let text = String::from_utf8_lossy(&std::fs::read(&file).expect("variables")).into_owned();
    let (numbers, _) = text.split_once("////P").expect("positions");
    let real =
        numbers.replacen("\r\n0,", "\r\n7,", 1) + "////P\r\n///TOOL 0\r\n///POSTYPE PULSE\r\nP0001=1,2,3,4,5,6\r\n";
    std::fs::write(&file, real).expect("it is written");
    assert_eq!(desk.data("-t sim:?from=press yerc var get B0")["items"][0]["value"], 7);
}

/// Robots of the backup `cell`.
const CELL: &str = "[[robot]]\nname = \"press\"\ntarget = \"sim:\"\nfamily = \"toyo\"\ntags = [\"line=3\"]\n\
                    [[robot]]\nname = \"weld\"\ntarget = \"sim:\"\nfamily = \"yerc\"\n";

#[test]
fn cell_serves_every_robot_of_a_backup() {
    let desk = Workspace::new(CELL);
    assert_eq!(desk.run("-q --all backup cell").exit, Some(0));
    let mut cell = desk.command("sim --cell cell --inventory desk.toml --speed 10x");
    let mut cell = cell.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("it starts");
    // The table of the robots is printed after the inventory is written.
    let mut line = String::new();
    BufReader::new(cell.stdout.take().expect("a pipe")).read_line(&mut line).expect("it prints");
    let status = desk.data("--config desk.toml -r press status --no-session");
    let tagged = desk.run("--config desk.toml --tag line=3 robots list");
    desk.data("--config desk.toml -r press toyo point set 3 1 2 3 4 --yes");
    let point = desk.data("--config desk.toml -r press toyo point get 3");
    let diff = desk.run("--config desk.toml -r weld diff cell");
    cell.kill().expect("it runs");
    cell.wait().expect("it ends");
    assert_eq!(status["mode"], "automatic", "{line}: {status}");
    assert!(tagged.stdout.contains("press") && !tagged.stdout.contains("weld"), "{tagged:?}");
    assert_eq!(point["items"][0]["value"]["x_mm"], 1.0, "{point}");
    assert_eq!(diff.exit, Some(0), "{diff:?}");
}

#[test]
fn rehearsal_reports_changes_and_needs_no_network() {
    if !Command::new("unshare").args(["-Urn", "true"]).status().is_ok_and(|status| status.success()) {
        println!("skipped: no user namespaces here");
        return;
    }
    let desk = Workspace::new(CELL);
    assert_eq!(desk.run("-q --all backup cell").exit, Some(0));
    let lines = "-r press toyo point set 3 1 2 3 4\n-r press toyo home\n-r weld yerc var set B7=99\n-r weld yerc job select NOWHERE\n";
    std::fs::write(desk.folder.path().join("morning.armctl"), lines).expect("it is written");
    // In this namespace, even the loopback interface is down.
    let rehearse = desk.command("-Urn -- armctl rehearse morning.armctl --from cell --speed 100x --keep-going --json");
    let mut alone = Command::new("unshare");
    alone.args(
        rehearse.get_args().map(|word| if word == "armctl" { env!("CARGO_BIN_EXE_armctl").as_ref() } else { word }),
    );
    alone.env_clear().envs(rehearse.get_envs().filter_map(|(key, value)| Some((key, value?))));
    alone.env("PATH", std::env::var_os("PATH").unwrap_or_default()).current_dir(desk.folder.path());
    let came = result_of(&alone.output().expect("unshare runs"));
    let report: Value = serde_json::from_str(&came.stdout).unwrap_or_else(|_| panic!("{came:?}"));
    let [press, weld] = &report["data"]["robots"].as_array().expect("robots")[..] else { panic!("{report}") };
    let change = |robot: &Value| robot["changes"].as_array().expect("values").clone();
    assert_eq!(change(press)[0]["name"], "3", "{press}");
    assert_eq!((&change(weld)[0]["old"], &change(weld)[0]["new"]), (&"7".into(), &"99".into()), "{weld}");
    assert_eq!(press["questions"].as_array().map(Vec::len), Some(1), "{press}");
    assert_ne!(came.exit, Some(0), "the last line is wrong: {came:?}");
    desk.fails("rehearse --from cell -- -t tcp://127.0.0.1:9 toyo status", 2, "only the robots of the backup");
    desk.fails("rehearse --from cell -- -r other toyo status", 2, "no robot 'other' in the backup");
}
