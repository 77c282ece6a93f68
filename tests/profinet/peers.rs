//! Our controller with a device of other authors (the crate `pnio`), and with our simulated device. Each end is in its
//! own network namespace, and virtual network cards connect them. The tests need user namespaces, but no privileges.
//! Without user namespaces, they print a message and pass.

#![cfg(target_os = "linux")]
#![expect(clippy::print_stdout, reason = "one end tells the other, and the log says what is skipped")]

use std::process::Command;
use std::time::{Duration, Instant};

use armctl_transport::image::tap::Tap;
use armctl_transport::image::{Event as LinkEvent, ImageLink, LinkError};
use armctl_transport::profinet::commission;
use armctl_transport::profinet::controller::view::State;
use armctl_transport::profinet::device::server::Server;
use armctl_transport::profinet::device::{Application, Event, Fault, Setup};
use armctl_transport::profinet::error::ProfinetError;
use armctl_transport::profinet::interface::Interface;
use armctl_transport::profinet::layout::Layout;
use armctl_transport::profinet::link::Link;
use armctl_transport::profinet::network::Network;
use armctl_transport::profinet::settings::{Settings, Station};
use armctl_transport::profinet::wire::Mac;
use armctl_transport::profinet::wire::dcp::Block;
use armctl_transport::profinet::wire::record::Im0;
use pnio::api::{IoDevice, StartOptions};
use pnio::config::{DeviceConfig, Slot};
use pnio::data::FieldType;
use pnio::device::RtOptions;
use pnio::diag::{ChannelError, Severity};

mod namespaces;

/// Both programs are this test binary. The name of the test selects the end.
const ENDS: &str = r#"
export ROLE=end
C=
if command -v tshark > /dev/null; then
    tshark -q -i pc0 -w "$CAPTURE" 2> "$CAPTURE.said" & C=$!
    wait_for Capturing "$CAPTURE.said" $C
fi
$THERE "$PROGRAM" --ignored --exact "${NAME}_device" --nocapture & D=$!
"$PROGRAM" --ignored --exact "${NAME}_controller" --nocapture
R=$?
kill $D
if [ -n "$C" ]; then kill -INT $C; wait $C; fi
exit $R
"#;

#[test]
fn our_controller_runs_another_device() {
    match run("others") {
        Some(text) => assert!(text.contains(WATCHDOG_MARK), "{text}"),
        None => println!("{}", namespaces::SKIPPED),
    }
}

/// Text that the other device prints when its controller is silent.
const WATCHDOG_MARK: &str = "the device's watchdog has expired";

#[test]
fn our_controller_finds_reads_and_runs_our_device() {
    if run("our").is_none() {
        println!("{}", namespaces::SKIPPED);
    }
}

#[test]
fn another_controller_runs_our_device() {
    run_peer_program("python");
}

#[test]
fn another_dcp_client_finds_and_names_our_device() {
    run_peer_program("dcp");
}

/// Runs a test with programs of other authors. It needs the folder that `tests/profinet/install` creates.
fn run_peer_program(name: &str) {
    if std::env::var_os(PEERS).is_none() {
        println!("skipped: {PEERS} does not name a folder of tests/profinet/install");
    } else if run(name).is_none() {
        println!("{}", namespaces::SKIPPED);
    }
}

const PEERS: &str = "ARMCTL_PROFINET_PEERS";

/// Runs the two ends of this test, and asserts that the controller finishes. Returns the output; `None` without user
/// namespaces.
fn run(name: &str) -> Option<String> {
    let program = std::env::current_exe().expect("this program has a path");
    let program = program.to_str().expect("the path is UTF-8");
    let folder = tempfile::tempdir().expect("a folder can be made");
    let capture = folder.path().join("all.pcapng");
    let capture = capture.to_str().expect("the path is UTF-8");
    let variables = [("PROGRAM", program), ("NAME", name), ("CAPTURE", capture)];
    let text = namespaces::run(ENDS, &variables)?;
    assert!(text.contains("the controller has seen all"), "{text}");
    // The filter ignores frames of the other program. It also ignores ICMP, which the system sends for closed ports.
    let ours = if ["others", "our"].contains(&name) { "02:00:00:00:00:01" } else { "02:00:00:00:00:02" };
    let wrong = format!("(_ws.malformed || _ws.expert.severity >= 0x600000) && eth.src == {ours} && !icmp");
    let read = |filter: &str| {
        let output = Command::new("tshark").arg("-r").arg(capture).args(["-Y", filter]).output().ok()?;
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        Some(String::from_utf8_lossy(&output.stdout).into_owned())
    };
    match read(&wrong) {
        Some(wrong) => {
            assert_eq!(wrong, "", "tshark has remarks");
            assert!(read(&format!("(pn_dcp || pn_io) && eth.src == {ours}")).is_some_and(|seen| !seen.is_empty()));
        }
        None => println!("no tshark here to read what passed"),
    }
    Some(text)
}

fn is_end_line() -> bool {
    std::env::var_os("ROLE").is_some()
}

/// A device that returns its outputs as inputs. It raises a diagnosis while the first word requests this, and reports a
/// silent controller.
#[test]
#[ignore = "one end of a test above"]
fn others_device() {
    const ALARM_MARK: u16 = 0x4141;
    if !is_end_line() {
        return;
    }
    let config = DeviceConfig::builder("yrcx-sim")
        .station_type("YRCX like")
        .identity(0xFFFF, 1)
        .min_device_interval(32)
        .input(Slot(1), &[FieldType::Word; 24])
        .output(Slot(2), &[FieldType::Word; 24])
        .build()
        .unwrap();
    let rt = RtOptions { iface: "pd0".to_owned(), cpu_pin: None, rt_priority: None, lock_memory: false };
    let options =
        StartOptions { iface: "pd0".to_owned(), ip: [192, 168, 79, 2], rt: Some(rt), app_cpus: None, im_store: None };
    let device = IoDevice::start(config, options).unwrap();
    let (mut is_raised, mut is_told) = (false, false);
    loop {
        std::thread::park_timeout(Duration::from_millis(2));
        if !is_told && device.rt_stats().snapshot().watchdog_expirations > 0 {
            is_told = true;
            println!("{WATCHDOG_MARK}");
        }
        if !device.ready() {
            continue;
        }
        let Ok(outputs) = device.outputs(Slot(2)) else { continue };
        let requested = outputs.word(0).is_ok_and(|word| word == ALARM_MARK);
        if requested != is_raised {
            is_raised = requested;
            if requested {
                device.raise_diagnosis(Slot(1), 0, ChannelError::LineBreak, Severity::Fault).unwrap();
            } else {
                device.clear_diagnosis(Slot(1), 0, ChannelError::LineBreak).unwrap();
            }
            assert_eq!(device.alarm_stats().unexpected_rx, 0);
        }
        let _ = device.with_inputs(Slot(1), |writer| {
            for at in 0..24 {
                writer.word(at, outputs.word(at)?)?;
            }
            Ok(())
        });
    }
}

fn settings() -> Settings {
    let layout = Layout::two_modules(0x101, 0x102);
    // The watchdog is so long that a busy machine does not lose the connection.
    let watchdog = Duration::from_millis(1920);
    let mut settings = Settings::new(Station::Name("yrcx-sim".to_owned()), layout);
    (settings.watchdog, settings.resting[32]) = (watchdog, 0x41);
    settings
}

#[test]
#[ignore = "one end of a test above"]
fn others_controller() {
    if !is_end_line() {
        return;
    }
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build().unwrap();
    runtime.block_on(async {
        let network = Network::shared("pc0").unwrap();
        let begin = Instant::now();
        // The device may not have started yet.
        let mut connection = loop {
            match network.open(settings(), Tap::default()).await {
                Err(ProfinetError::NotFound { .. }) if begin.elapsed() < Duration::from_secs(30) => {}
                opened => break opened.unwrap(),
            }
        };
        println!("open after {:?}: {:?}", begin.elapsed(), connection.views.now().details.device);
        for round in 0..3u8 {
            let mut image = vec![round + 1; 48];
            let generation = connection.views.now().generation;
            connection.set_image(generation, &image).unwrap();
            let shown = image.clone();
            connection.views.until(|view| view.input.as_ref().is_some_and(|input| *input.image == *shown)).await;
            assert_eq!(connection.views.now().generation, 1);
            // The diagnosis appears and disappears.
            for (word, kind) in [(0x41, 0x01), (0, 0x0C)] {
                image[..2].fill(word);
                connection.set_image(generation, &image).unwrap();
                let alarms = connection.views.now().statistics.alarms;
                connection.views.until(|view| view.statistics.alarms > alarms || view.state != State::Open).await;
                let alarm = connection.take_alarm().expect("an alarm came");
                println!("{}", alarm.describe());
                assert!(alarm.kind == kind || kind == 0x0C, "{alarm:?}");
            }
        }
        let counted = connection.views.now().statistics;
        println!("{counted:?}");
        assert_eq!((connection.views.now().generation, counted.losses, counted.stale), (1, 0, 0));

        // A suspended program sends nothing. Both ends close the connection and then open it again.
        let pause = format!("kill -STOP {0}; sleep 4; kill -CONT {0}", std::process::id());
        let mut pause = Command::new("sh").args(["-c", &pause]).spawn().unwrap();
        let lost = connection.views.until(|view| view.statistics.losses == 1).await;
        println!("after a pause: {:?}", lost.last_error);
        connection.views.until(|view| view.state == State::Open && view.generation == 2).await;
        pause.wait().unwrap();
        connection.close().await.unwrap();

        // A second connection is possible at once, because the release has freed the device.
        let connection = network.open(settings(), Tap::default()).await.unwrap();
        connection.close().await.unwrap();

        let wrong = Settings { layout: Layout::two_modules(0x99, 0x102), ..settings() };
        let refused = network.open(wrong, Tap::default()).await.unwrap_err();
        println!("another module: {refused}");
        assert!(matches!(refused, ProfinetError::Refused { .. } | ProfinetError::Modules(_)));

        let absent_station = Settings { station: Station::Name("nobody".to_owned()), ..settings() };
        let refused = network.open(absent_station, Tap::default()).await.unwrap_err();
        assert!(matches!(refused, ProfinetError::NotFound { .. }));
    });
    println!("the controller has seen all");
}

/// An application that returns its outputs as inputs.
#[derive(Debug, Default)]
struct Echo(Vec<u8>);

impl Application for Echo {
    fn image_out(&mut self, _: Duration, image: Option<&[u8]>) {
        self.0 = image.unwrap_or_default().to_vec();
    }

    fn image_in(&mut self, _: Duration, image: &mut [u8]) {
        image.fill(0);
        let length = image.len().min(self.0.len());
        image[..length].copy_from_slice(&self.0[..length]);
    }

    fn event(&mut self, _: Duration, _: &Event) {}
}

#[test]
#[ignore = "one end of a test above"]
fn our_device() {
    if !is_end_line() {
        return;
    }
    let interface = Interface::find("pd0").unwrap();
    let setup = Setup {
        mac: Mac::default(),
        name: "yrcx-sim".to_owned(),
        kind: "YRCX like".to_owned(),
        id: (0xFFFF, 1),
        instance: 1,
        ip: None,
        takes_ip: false,
        layout: Layout::two_modules(0x101, 0x102),
        shortest: 32,
        im0: Im0 { order_id: "RCX340".to_owned(), software: ('V', 1, 2, 3), ..Im0::default() },
    };
    let server = Server::start(&interface, setup, Echo::default()).unwrap();
    assert!(matches!(Network::shared("pd0"), Err(ProfinetError::PortTaken(_))));
    loop {
        // If the first word is 0x55, the controller requests that the device goes to stop.
        let wants_stop = server.with(|device, _| device.application.0.first() == Some(&0x55));
        if wants_stop {
            server.with(|device, _| device.set_fault(Some(Fault::Stop)));
            // The fault stays until the controller has received the state and has disconnected.
            while server.with(|device, _| device.application.0.first() == Some(&0x55)) {
                std::thread::park_timeout(Duration::from_millis(5));
            }
            server.with(|device, _| device.set_fault(None));
        }
        std::thread::park_timeout(Duration::from_millis(5));
    }
}

#[test]
#[ignore = "one end of a test above"]
fn our_controller() {
    if !is_end_line() {
        return;
    }
    let Err(ProfinetError::NoInterface { present, .. }) = Interface::find("eth9") else { panic!("there is eth9") };
    assert!(present.contains(&"pc0".to_owned()), "{present:?}");
    let interface = Interface::find("pc0").expect("the namespace has it");
    let station = Station::Name("yrcx-sim".to_owned());
    let begin = Instant::now();
    let found = loop {
        match commission::find(&interface, &station) {
            Err(ProfinetError::NotFound { .. }) if begin.elapsed() < Duration::from_secs(30) => {}
            found => break found.unwrap(),
        }
    };
    let all = commission::stations(&interface, Duration::from_secs(2)).unwrap();
    assert_eq!(all.iter().map(|found| found.mac).collect::<Vec<_>>(), [found.mac]);
    let identity = commission::identity(&interface, &found).unwrap();
    assert_eq!(identity.im0.unwrap().order_id, "RCX340");
    assert_eq!(identity.modules.unwrap()[1].ident, 0x101);
    commission::change(&interface, found.mac, "DCP signal", &Block::signal()).unwrap();
    let bad = commission::change(&interface, found.mac, "DCP Set name", &Block::set_name("Robot", true)).unwrap_err();
    assert!(matches!(bad, ProfinetError::Dcp { error: 3, .. }), "{bad}");
    let nobody = Mac([2, 0, 0, 0, 0, 0x77]);
    let silent = commission::change(&interface, nobody, "DCP signal", &Block::signal()).unwrap_err();
    assert!(matches!(silent, ProfinetError::NoAnswer { .. }), "{silent}");
    // The operating systems at both ends answer ARP requests. Our device does not answer them.
    let holder = |last, except| commission::holder(&interface, [192, 168, 79, last].into(), except).unwrap();
    assert_eq!((holder(2, nobody), holder(2, found.mac), holder(7, nobody)), (Some(found.mac), None, None));
    assert_eq!(holder(1, nobody), Some(interface.mac));

    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build().unwrap();
    runtime.block_on(async {
        let deadline = || tokio::time::Instant::now() + Duration::from_secs(30);
        let mut link = ImageLink::over(Link::open("pc0", settings(), Tap::default()).await.unwrap());
        let mut image = settings().resting;
        image[0] = 0x55;
        link.set_output(&image).unwrap();
        let mut events = Vec::new();
        while !events.iter().any(|event| matches!(event, LinkEvent::Reopened)) {
            let event = link.next(deadline()).await;
            assert_ne!(event, LinkEvent::Timeout, "{events:?}");
            events.push(event);
        }
        assert!(events.contains(&LinkEvent::Sent), "{events:?}");
        let lost = events.iter().find_map(|event| match event {
            LinkEvent::Lost(error) => Some(error.to_string()),
            _ => None,
        });
        assert!(lost.unwrap().contains("in the stop state"));
        // After a new connection, the link does not show the old inputs again.
        let rest = settings().resting;
        loop {
            match link.next(deadline()).await {
                LinkEvent::Image(image) if *image == *rest => break,
                LinkEvent::Image(image) => assert_ne!(image[0], 0x55),
                event => assert_ne!(event, LinkEvent::Timeout),
            }
        }
        let second = Link::open("pc0", settings(), Tap::default()).await.unwrap_err();
        assert!(matches!(LinkError::from(second), LinkError::Owned(_)));
        link.close().await.unwrap();
    });
    println!("the controller has seen all");
}

#[test]
#[ignore = "one end of a test above"]
fn python_device() {
    our_device();
}

#[test]
#[ignore = "one end of a test above"]
fn dcp_device() {
    our_device();
}

#[test]
#[ignore = "one end of a test above"]
fn python_controller() {
    if is_end_line() {
        run_python(include_str!("controller.py"), &["pc0", "yrcx-sim"], "profinet-py has seen its data come back");
    }
}

#[test]
#[ignore = "one end of a test above"]
fn dcp_controller() {
    if is_end_line() {
        run_python(include_str!("dcp.py"), &["192.168.79.1", "yrcx-sim"], "pnio-dcp has seen all");
    }
}

/// Runs a program in Python when our device has started.
fn run_python(program: &str, arguments: &[&str], end: &str) {
    let interface = Interface::find("pc0").expect("the namespace has it");
    let station = Station::Name("yrcx-sim".to_owned());
    let begin = Instant::now();
    while commission::find(&interface, &station).is_err() {
        assert!(begin.elapsed() < Duration::from_secs(30));
    }
    let python = std::path::Path::new(&std::env::var_os(PEERS).expect("it is set")).join("bin/python");
    let output = Command::new(python).arg("-c").arg(program).args(arguments).output().expect("python can be started");
    let output = format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    println!("{output}");
    assert!(output.contains(end), "{output}");
    println!("the controller has seen all");
}
