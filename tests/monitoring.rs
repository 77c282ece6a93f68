//! `armctl serve metrics` and `armctl publish` as services. `promtool` and Prometheus read the pages and the files of
//! `docs/monitoring/`. Other tests check notifications to the service manager, the journal, and the end of a service. A
//! test that needs a missing program is skipped with a message.

#![expect(clippy::print_stdout, reason = "a test that is skipped says so")]

use std::io::{BufRead as _, BufReader, Read as _, Write as _};
use std::net::{SocketAddr, TcpListener, TcpStream};
use std::os::fd::OwnedFd;
use std::os::unix::fs::MetadataExt as _;
use std::os::unix::net::{UnixDatagram, UnixStream};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Output, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use serde_json::Value;
use tempfile::TempDir;

use crate::support::simulator::Simulator;

/// A process that ends when the value is dropped.
struct Service {
    process: Child,
}

impl Service {
    fn signal(&self, name: &str) {
        let sent = Command::new("kill").args([&format!("-{name}"), &self.process.id().to_string()]).status();
        assert!(sent.expect("kill is there").success());
    }

    fn end(&mut self) -> ExitStatus {
        self.process.wait().expect("it ends")
    }
}

impl Drop for Service {
    fn drop(&mut self) {
        let _gone = self.process.kill();
        let _ended = self.process.wait();
    }
}

/// Creates a folder with an inventory of these robots: name, family, target.
fn create_inventory(robots: &[(&str, &str, &str)]) -> TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    write(folder.path(), robots);
    folder
}

fn write(folder: &Path, robots: &[(&str, &str, &str)]) {
    let entry = |(name, family, target): &(&str, &str, &str)| {
        format!("[[robot]]\nname = \"{name}\"\nfamily = \"{family}\"\ntarget = \"{target}\"\nretries = 0\n")
    };
    std::fs::write(folder.join("robots.toml"), robots.iter().map(entry).collect::<String>()).expect("written");
}

fn armctl(folder: &Path) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_armctl"));
    command.env_clear().env("HOME", folder).env("XDG_RUNTIME_DIR", folder).env("PATH", "/usr/bin:/bin");
    command.env("ARMCTL_CONFIG", folder.join("robots.toml")).stdin(Stdio::null());
    command
}

/// Starts a metrics service on a free port, and returns its address.
fn serve(mut command: Command) -> (Service, SocketAddr) {
    command.args(["serve", "metrics", "--listen", "127.0.0.1:0", "--watch", "100ms"]).stdout(Stdio::piped());
    let mut process = command.spawn().expect("it starts");
    let mut line = String::new();
    BufReader::new(process.stdout.take().expect("a pipe")).read_line(&mut line).expect("it says where it is");
    let (_, place) = line.split_once("http://").unwrap_or_else(|| panic!("no URL: {line}"));
    let place = place.trim_end().trim_end_matches("/metrics").parse().expect("an address");
    (Service { process }, place)
}

/// Gets the page at a path. Returns its header and its body.
fn get(at: SocketAddr, path: &str, accept: &str) -> (String, String) {
    let mut stream = TcpStream::connect(at).expect("somebody listens");
    write!(stream, "GET {path} HTTP/1.1\r\nHost: {at}\r\nAccept: {accept}\r\nConnection: close\r\n\r\n").expect("sent");
    let mut messages = String::new();
    stream.read_to_string(&mut messages).expect("an answer");
    let (head, body) = messages.split_once("\r\n\r\n").unwrap_or_else(|| panic!("no answer: {messages}"));
    (head.to_owned(), body.to_owned())
}

fn page(at: SocketAddr) -> String {
    get(at, "/metrics", "text/plain").1
}

/// Repeats a request until it returns a value.
fn wait_until<T>(what: &str, mut ask: impl FnMut() -> Option<T>) -> T {
    /// Maximum time for the repetition.
    const TIMEOUT: Duration = Duration::from_secs(120);

    let began = Instant::now();
    loop {
        if let Some(found) = ask() {
            return found;
        }
        assert!(began.elapsed() < TIMEOUT, "it does not come to this: {what}");
        thread::sleep(Duration::from_millis(20));
    }
}

/// Whether a program is installed. If it is not, prints why the test is skipped.
fn has_program(program: &str) -> bool {
    let found = Command::new(program).arg("--version").stdout(Stdio::null()).stderr(Stdio::null()).status().is_ok();
    if !found {
        println!("skipped: there is no {program} here");
    }
    found
}

/// Whether a process can have its own network and its own mounts.
fn has_namespaces() -> bool {
    let alone = Command::new("unshare").args(["-Urnm", "true"]).stderr(Stdio::null()).status();
    let has = alone.is_ok_and(|status| status.success());
    if !has {
        println!("skipped: there are no user namespaces here");
    }
    has
}

fn documentation_folder(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/monitoring").join(name)
}

fn assert_success(output: &Output) {
    let [out, err] = [&output.stdout, &output.stderr].map(|text| String::from_utf8_lossy(text).into_owned());
    assert!(output.status.success(), "{}\n{out}{err}", output.status);
}

fn promtool(words: &[&str]) {
    let output =
        Command::new("promtool").args(words).current_dir(documentation_folder("")).output().expect("promtool runs");
    assert_success(&output);
}

/// One simulator of each family, and an inventory that also has an unreachable robot.
fn mixed_fleet() -> (Vec<Simulator>, TempDir) {
    let simulators: Vec<Simulator> = ["yerc", "yrcx", "toyo"].map(Simulator::start).into();
    let urls: Vec<&str> = simulators.iter().map(|simulator| simulator.url.as_str()).collect();
    let robots = [
        ("cell3", "yerc", urls[0]),
        ("press", "yrcx", urls[1]),
        ("loader", "toyo", urls[2]),
        ("gone", "toyo", "tcp://127.0.0.1:1"),
    ];
    let folder = create_inventory(&robots);
    (simulators, folder)
}

/// Waits until the page has a state for all four robots. Returns the page.
fn known_metrics(at: SocketAddr) -> String {
    wait_until("all robots are known", || {
        let page = page(at);
        (page.matches("\narmctl_robot_up{").count() == 4).then_some(page)
    })
}

#[test]
fn serves_pages_in_the_requested_format() {
    let (_simulators, folder) = mixed_fleet();
    let (_service, at) = serve(armctl(folder.path()));
    let text = known_metrics(at);
    assert!(text.contains("armctl_robot_up{robot=\"cell3\",family=\"yerc\"} 1\n"), "{text}");
    assert!(text.contains("armctl_robot_up{robot=\"gone\",family=\"toyo\"} 0\n"), "{text}");
    // Every metric on the page of the documentation must exist.
    let shown = std::fs::read_to_string(documentation_folder("README.md")).expect("the page is there");
    let shown = shown.split("```text\n").nth(1).and_then(|rest| rest.split("```").next()).expect("a page");
    for line in shown.lines() {
        assert!(text.lines().any(|value| value == line), "{line} is not in\n{text}");
    }
    let (head, open) = get(at, "/metrics", "application/openmetrics-text;version=1.0.0,text/plain;q=0.5");
    assert!(head.contains("application/openmetrics-text; version=1.0.0; charset=utf-8"), "{head}");
    assert!(open.ends_with("\n# EOF\n") && open.contains("# UNIT armctl_axis_position_meters meters\n"), "{open}");
    assert_eq!(get(at, "/healthz", "*/*").1, "ok\n");
    assert!(get(at, "/", "*/*").0.starts_with("HTTP/1.1 404 "));
    if has_program("promtool") {
        let mut check =
            Command::new("promtool").args(["check", "metrics"]).stdin(Stdio::piped()).spawn().expect("runs");
        check.stdin.take().expect("a pipe").write_all(text.as_bytes()).expect("read");
        assert!(check.wait().expect("it ends").success());
    }
}

#[test]
fn prometheus_accepts_rules_and_configuration() {
    if !has_program("promtool") {
        return;
    }
    promtool(&["check", "config", "prometheus.yml"]);
    promtool(&["test", "rules", "alerts_test.yml"]);
    let [rules, tests] = ["alerts.yml", "alerts_test.yml"]
        .map(|name| std::fs::read_to_string(documentation_folder(name)).expect("it is there"));
    for alert in rules.lines().filter_map(|line| line.trim().strip_prefix("- alert: ")) {
        assert!(tests.contains(&format!("alertname: {alert}\n")), "{alert} has no test");
    }
}

#[test]
fn dashboard_queries_existing_metrics() {
    let text = std::fs::read_to_string(documentation_folder("dashboard.json")).expect("it is there");
    let dashboard: Value = serde_json::from_str(&text).expect("JSON");
    let panels = dashboard["panels"].as_array().expect("panels");
    let of = |panel: &Value| panel["targets"].as_array().cloned().unwrap_or_default();
    let queries: Vec<String> =
        panels.iter().flat_map(of).filter_map(|target| target["expr"].as_str().map(str::to_owned)).collect();
    assert!(queries.len() > 15);
    let page = std::fs::read_to_string(documentation_folder("README.md")).expect("the page is there");
    let mut rules = "groups:\n- name: dashboard\n  rules:\n".to_owned();
    for (number, question) in queries.iter().enumerate() {
        for name in
            question.split(|c: char| !c.is_ascii_lowercase() && c != '_').filter(|word| word.starts_with("armctl_"))
        {
            let known = page.contains(&format!("`{}`", name.trim_end_matches("_bucket")));
            assert!(known, "{name} is not one of the metrics: {question}");
        }
        let question = question.replace("$__rate_interval", "1m").replace(['\n', '\''], " ");
        rules += &format!("  - record: q{number}\n    expr: '{question}'\n");
    }
    if has_program("promtool") {
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join("rules.yml");
        std::fs::write(&file, rules).expect("written");
        promtool(&["check", "rules", file.to_str().expect("a path")]);
    }
}

#[test]
fn prometheus_scrapes_metrics_and_fires_alerts() {
    if !has_program("prometheus") {
        return;
    }
    let (simulators, folder) = mixed_fleet();
    let (_service, at) = serve(armctl(folder.path()));
    known_metrics(at);
    let (_prometheus, prometheus) = prometheus(folder.path(), at);
    let ask = |question: &str| -> Vec<(Value, String)> {
        let Some(answer) = query(prometheus, question) else { return Vec::new() };
        let results = answer["data"]["result"].as_array().cloned().unwrap_or_default();
        results
            .into_iter()
            .map(|found| (found["metric"].clone(), found["value"][1].as_str().unwrap_or_default().to_owned()))
            .collect()
    };
    let names = |found: Vec<(Value, String)>| -> Vec<String> {
        let mut names: Vec<String> =
            found.iter().filter_map(|(labels, _)| labels["robot"].as_str().map(str::to_owned)).collect();
        names.sort();
        names
    };
    wait_until("three answer", || (names(ask("armctl_robot_up == 1")) == ["cell3", "loader", "press"]).then_some(()));
    wait_until("it is read", || ask("up{job=\"armctl\"}").iter().any(|(_, value)| value == "1").then_some(()));
    // One robot has X, Y and Z, and another robot has four axes. A YRCX reports no position if no session holds its
    // command connection.
    wait_until("positions are there", || (ask("armctl_axis_position_meters").len() == 3 + 4).then_some(()));
    let rate = "histogram_quantile(0.99, sum by (robot, le) (rate(armctl_poll_duration_seconds_bucket[1m])))";
    wait_until("a histogram is one", || ask(rate).iter().any(|(_, value)| value != "NaN").then_some(()));
    // In OpenMetrics, the name of a counter family does not end in `_total`.
    wait_until("its type is known", || {
        let alert_state = get(prometheus, "/api/v1/metadata?metric=armctl_polls", "*/*").1;
        alert_state.contains("\"counter\"").then_some(())
    });
    let pending = "ALERTS{alertname=\"RobotDown\"}";
    wait_until("who is gone is in the list of alerts", || (names(ask(pending)) == ["gone"]).then_some(()));
    drop(simulators);
    wait_until("nobody answers", || {
        (names(ask("armctl_robot_up == 0")) == ["cell3", "gone", "loader", "press"]).then_some(())
    });
    wait_until("and all are in the list", || (names(ask(pending)).len() == 4).then_some(()));
}

/// Starts Prometheus, which reads metrics from this address five times per second.
fn prometheus(folder: &Path, at: SocketAddr) -> (Service, SocketAddr) {
    let config = std::fs::read_to_string(documentation_folder("prometheus.yml")).expect("it is there");
    let config = config.replace("127.0.0.1:9464", &at.to_string()).replace(": 5s", ": 200ms");
    let config = config.replace("- alerts.yml", &format!("- {}", documentation_folder("alerts.yml").display()));
    std::fs::write(folder.join("prometheus.yml"), config).expect("written");
    let free = TcpListener::bind("127.0.0.1:0").and_then(|listener| listener.local_addr()).expect("a port");
    let mut command = Command::new("prometheus");
    command.arg("--config.file").arg(folder.join("prometheus.yml")).arg("--storage.tsdb.path").arg(folder.join("data"));
    command.args(["--web.listen-address", &free.to_string(), "--log.level", "error"]);
    command.current_dir(folder).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    let service = Service { process: command.spawn().expect("it starts") };
    wait_until("Prometheus is ready", || {
        TcpStream::connect(free).is_ok().then(|| get(free, "/-/ready", "*/*").0).filter(|head| head.contains(" 200 "))
    });
    (service, free)
}

fn query(at: SocketAddr, question: &str) -> Option<Value> {
    let escaped: String = question.bytes().map(|byte| format!("%{byte:02x}")).collect();
    let (head, body) = get(at, &format!("/api/v1/query?query={escaped}"), "application/json");
    // A long answer is sent in chunks, each after a line with its length.
    let body = if head.to_lowercase().contains("transfer-encoding: chunked") { join_chunks(&body) } else { body };
    serde_json::from_str(&body).ok()
}

fn join_chunks(mut pieces: &str) -> String {
    let mut body = String::new();
    while let Some((length, rest)) = pieces.split_once("\r\n") {
        let length = usize::from_str_radix(length.trim(), 16).unwrap_or(0);
        if length == 0 {
            break;
        }
        body += rest.get(..length).unwrap_or_default();
        pieces = rest.get(length + 2..).unwrap_or_default();
    }
    body
}

#[test]
fn follows_added_and_removed_robots() {
    let simulator = Simulator::start("toyo");
    let folder = create_inventory(&[("loader", "toyo", &simulator.url)]);
    let (_service, at) = serve(armctl(folder.path()));
    let has = |what: &'static str| wait_until(what, || page(at).contains(what).then_some(()));
    has("armctl_robot_up{robot=\"loader\",family=\"toyo\"} 1\n");
    std::fs::write(folder.path().join("robots.toml"), "[[robot]\n").expect("written");
    has("armctl_inventory_last_reload_successful 0\n");
    has("armctl_robot_up{robot=\"loader\",family=\"toyo\"} 1\n");
    write(folder.path(), &[("hand", "toyo", &simulator.url), ("cell9", "yerc", "sim:")]);
    has("armctl_robot_up{robot=\"hand\",family=\"toyo\"} 1\n");
    has("armctl_robot_up{robot=\"cell9\",family=\"yerc\"} 1\n");
    assert!(!page(at).contains("loader"));
    assert!(page(at).contains("armctl_inventory_last_reload_successful 1\n"));
}

/// Runs a service with one reachable robot. Checks the notifications to the service manager, with the additional text
/// `besides`, and the end at SIGTERM.
fn is_managed(words: &[&str], besides: &str) {
    let folder = create_inventory(&[("cell3", "yerc", "sim:"), ("gone", "toyo", "tcp://127.0.0.1:1")]);
    let path = folder.path().join("notify");
    let manager = UnixDatagram::bind(&path).expect("a socket");
    let mut command = armctl(folder.path());
    command.args(words).args(["--watch", "100ms"]).env("NOTIFY_SOCKET", &path).env("WATCHDOG_USEC", "200000");
    let mut service = Service { process: command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().expect("starts") };
    let notifications = || {
        let mut text = [0; 200];
        let length = manager.recv(&mut text).expect("it is told");
        String::from_utf8_lossy(&text[..length]).into_owned()
    };
    assert_eq!(notifications(), "READY=1\nSTATUS=2 robots");
    while notifications() != format!("WATCHDOG=1\nSTATUS=2 robots, 1 answers{besides}") {}
    service.signal("TERM");
    while notifications() != "STOPPING=1" {}
    assert_eq!(service.end().code(), Some(0));
}

#[test]
fn notifies_the_service_manager_and_ends_on_sigterm() {
    is_managed(&["serve", "metrics", "--listen", "127.0.0.1:0"], "");
    // A missing broker must not delay the notifications to the service manager.
    is_managed(&["publish", "mqtt://127.0.0.1:1"], "; not connected to mqtt://127.0.0.1:1");
}

#[test]
fn idle_connections_do_not_block_a_page() {
    let folder = create_inventory(&[("cell3", "yerc", "sim:")]);
    let (_service, at) = serve(armctl(folder.path()));
    let silent: Vec<TcpStream> = (0..64)
        .map(|number| {
            let mut stream = TcpStream::connect(at).expect("somebody listens");
            if number % 2 == 0 {
                stream.write_all(b"GET /metrics HTTP/1.1\r\nHost").expect("sent");
            }
            stream
        })
        .collect();
    assert!(page(at).contains("armctl_"), "there is a page");
    // The newest connections are still open, because their time limit has not passed yet.
    for mut stream in silent.into_iter().skip(40) {
        stream.set_nonblocking(true).expect("set");
        let read = stream.read(&mut [0; 1]).map_err(|error| error.kind());
        assert_eq!(read, Err(std::io::ErrorKind::WouldBlock));
    }
}

/// Log file of a service. The environment of the service can declare this file to be the journal.
struct Log {
    path: PathBuf,
    _service: Service,
}

impl Log {
    fn start(mut command: Command, folder: &Path, is_journal: bool) -> Self {
        let path = folder.join("log");
        let file = std::fs::File::create(&path).expect("a file");
        let stat = file.metadata().expect("it is there");
        // A service that is started from a terminal can inherit the variable. The inode in the variable is then not the
        // inode of its stderr.
        let inode = if is_journal { stat.ino() } else { stat.ino() + 1 };
        command.env("JOURNAL_STREAM", format!("{}:{inode}", stat.dev())).stderr(file).stdout(Stdio::null());
        Self { path, _service: Service { process: command.spawn().expect("it starts") } }
    }

    fn has(&self, wanted: &[&str]) -> String {
        wait_until("a line of the log", || {
            let text = std::fs::read_to_string(&self.path).expect("it is there");
            text.lines().find(|line| wanted.iter().all(|part| line.contains(part))).map(str::to_owned)
        })
    }
}

#[test]
fn journal_gets_priorities_and_fields_and_a_file_gets_text() {
    let metrics = ["serve", "metrics", "--listen", "127.0.0.1:0"];
    for words in [&metrics[..], &["publish", "mqtt://127.0.0.1:1"]] {
        let folder = create_inventory(&[("gone", "toyo", "tcp://127.0.0.1:1")]);
        let mut command = armctl(folder.path());
        command.args(words).args(["--watch", "100ms"]);
        let log = Log::start(command, folder.path(), true);
        let line = log.has(&["<4>gone (tcp://127.0.0.1:1)", "robot=gone family=toyo kind=no_answer"]);
        assert!(line.starts_with("<4>"), "{line}");
        std::fs::write(folder.path().join("robots.toml"), "[[robot]\n").expect("written");
        log.has(&["<4>", "robots.toml:1:", "armctl keeps the earlier robots", "kind=usage"]);
        write(folder.path(), &[("cell3", "yerc", "sim:")]);
        log.has(&["<5>gone (tcp://127.0.0.1:1): is no longer polled robot=gone family=toyo"]);
        log.has(&["<5>cell3 (sim:): is polled from now on robot=cell3 family=yerc"]);
        if words[0] == "publish" {
            log.has(&[
                "<4>mqtt://127.0.0.1:1: no program listens on this port",
                "next try in",
                " broker=mqtt://127.0.0.1:1",
            ]);
        }
    }
    let folder = create_inventory(&[("gone", "toyo", "tcp://127.0.0.1:1")]);
    let mut command = armctl(folder.path());
    command.args(metrics);
    let line = Log::start(command, folder.path(), false).has(&["gone (tcp://127.0.0.1:1)"]);
    assert!(line.starts_with("warning: gone (tcp://127.0.0.1:1)") && !line.contains("kind="), "{line}");
}

/// Runs in its own namespace, in which this test replaces the journal.
#[test]
fn journal_entries_have_fields() {
    if !has_namespaces() {
        return;
    }
    let folder = create_inventory(&[("gone", "toyo", "tcp://127.0.0.1:1")]);
    let journal = UnixDatagram::bind(folder.path().join("socket")).expect("a socket");
    let (stderr, _other_end) = UnixStream::pair().expect("a pair");
    let stderr = std::fs::File::from(OwnedFd::from(stderr));
    let stat = stderr.metadata().expect("it is there");
    let place = "mount -t tmpfs none /run && mkdir /run/systemd && ln -s \"$0\" /run/systemd/journal && exec \"$@\"";
    let own = armctl(folder.path());
    let mut command = Command::new("unshare");
    command.args(["-Urm", "sh", "-c", place]).arg(folder.path()).arg(own.get_program());
    command.args(["serve", "metrics", "--listen", "127.0.0.1:0"]);
    command.envs(own.get_envs().filter_map(|(name, value)| Some((name, value?))));
    command.env("JOURNAL_STREAM", format!("{}:{}", stat.dev(), stat.ino()));
    command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(stderr);
    let _service = Service { process: command.spawn().expect("it starts") };
    let mut entry = [0; 1000];
    let length = journal.recv(&mut entry).expect("it is written");
    let entry = String::from_utf8_lossy(&entry[..length]);
    assert!(entry.starts_with("MESSAGE=gone (tcp://127.0.0.1:1): "), "{entry}");
    let fields = "\nPRIORITY=4\nSYSLOG_IDENTIFIER=armctl\nROBOT=gone\nFAMILY=toyo\nKIND=no_answer\n";
    assert!(entry.ends_with(fields), "{entry}");
}

#[test]
fn warns_about_a_reachable_port() {
    let folder = create_inventory(&[("cell3", "yerc", "sim:")]);
    let log = folder.path().join("log");
    // Runs in its own namespace with an empty network.
    if !has_namespaces() {
        return;
    }
    let mut command = Command::new("unshare");
    command.args(["-Urn", env!("CARGO_BIN_EXE_armctl"), "serve", "metrics", "--listen", "0.0.0.0"]);
    command.env_clear().env("HOME", folder.path()).env("ARMCTL_CONFIG", folder.path().join("robots.toml"));
    command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(std::fs::File::create(&log).expect("a file"));
    let _service = Service { process: command.spawn().expect("it starts") };
    let said = wait_until("a warning", || std::fs::read_to_string(&log).ok().filter(|text| text.contains('\n')));
    assert!(said.starts_with("warning: everyone on the network can read") && said.contains("no password"), "{said}");
}

#[test]
fn reports_a_port_in_use() {
    let taken = TcpListener::bind("127.0.0.1:0").expect("a port");
    let folder = create_inventory(&[("cell3", "yerc", "sim:")]);
    let words =
        ["serve", "metrics", "--listen", &taken.local_addr().expect("an address").to_string()].map(str::to_owned);
    let output = armctl(folder.path()).args(words).output().expect("it runs");
    assert_eq!(output.status.code(), Some(4));
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(said.contains("already in use") && said.contains("--listen 127.0.0.1:9465"), "{said}");
}

#[test]
fn systemd_accepts_the_units() {
    let folder = tempfile::tempdir().expect("a folder");
    let hardening = ["armctl-metrics.service", "armctl-publish.service"].map(|name| {
        let text = std::fs::read_to_string(documentation_folder(name)).expect("it is there");
        // The unit reports when it is ready, is watched and restarted, and has a valid command line.
        for wanted in ["Type=notify", "WatchdogSec=", "Restart=on-failure", "DynamicUser=yes", "NoNewPrivileges=yes"] {
            assert!(text.contains(wanted), "{name}: {wanted}");
        }
        if has_program("systemd-analyze") {
            let unit = folder.path().join(name);
            // systemd finds the program of a package or of an archive; here it is in neither place.
            let started = concat!("ExecStart=", env!("CARGO_BIN_EXE_armctl"));
            std::fs::write(&unit, text.replace("ExecStart=armctl", started)).expect("written");
            let mut verify = Command::new("systemd-analyze");
            assert_success(&verify.args(["verify", "--man=no"]).arg(&unit).output().expect("it runs"));
        }
        let own = text.lines().skip_while(|line| *line != "DynamicUser=yes").filter(|line| !line.starts_with('#'));
        own.map(str::to_owned).collect::<Vec<_>>()
    });
    assert!(hardening[0] == hardening[1] && hardening[0].len() > 20, "one may do no more than the other");
}
