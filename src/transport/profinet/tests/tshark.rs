//! Comparison with `tshark`, if it is installed. `tshark` must decode all traffic without a warning and with the
//! intended meaning.

use std::fs;
use std::process::Command;

use super::super::device::{Event, Fault, Setup};
use super::super::layout::Layout;
use super::super::settings::Settings;
use super::super::wire::alarm::{Notification, Priority};
use super::super::wire::record::Parameter;
use super::world::{MS, World, settings, setup, suite};

/// Creates a pcap file of Ethernet frames.
fn capture(record: &[(std::time::Duration, Vec<u8>)]) -> Vec<u8> {
    let mut out = Vec::new();
    for number in [0xA1B2_C3D4_u32, 0x0002_0004, 0, 0, 65_535, 1] {
        // The number contains the version of the file format, which has two 16-bit numbers.
        out.extend(if number == 0x0002_0004 { vec![2, 0, 4, 0] } else { number.to_le_bytes().to_vec() });
    }
    for (at, bytes) in record {
        let length = u32::try_from(bytes.len()).unwrap();
        for number in [u32::try_from(at.as_secs()).unwrap(), at.subsec_micros(), length, length] {
            out.extend(number.to_le_bytes());
        }
        out.extend(bytes);
    }
    out
}

/// Records a complete connection: address, parameters, data, alarms, a loss, a refusal, a release.
fn life() -> Vec<(std::time::Duration, Vec<u8>)> {
    let bare = Setup { ip: None, ..setup() };
    let parameter = |index, data: &[u8]| Parameter { slot: 1, subslot: 1, index, data: data.to_vec() };
    let settings = Settings {
        ip: Some(suite([192, 168, 78, 2])),
        parameters: vec![parameter(1, &[1, 2, 3]), parameter(2, &[4])],
        ..settings()
    };
    let mut world = World::new(bare, settings, "");
    world.record = Some(Vec::new());
    world.until_open();
    for priority in Priority::ALL {
        let detail = Some((0x8000, vec![0x80, 0, 0x28, 0, 0, 6]));
        let alarm = Notification {
            priority,
            kind: 1,
            api: 0,
            slot: 1,
            subslot: 1,
            module: 0x101,
            submodule: 1,
            specifier: 0xA800,
            detail,
        };
        world.device.raise(world.now, &alarm);
        world.run(100 * MS);
    }
    world.device.abort(world.now, 5);
    world.run(200 * MS);
    world.until_open();
    world.controller.close(world.now);
    world.run_to_deadline();
    assert!(world.device.application.events.contains(&Event::Ended(None)));
    let mut record = world.record.take().unwrap();
    // A second device follows. Its answer to Connect reports a different module.
    let mut world = World::new(setup(), super::world::settings(), "");
    world.now += std::time::Duration::from_secs(1000);
    world.record = Some(Vec::new());
    world.device.set_fault(Some(Fault::WrongModule));
    world.run_to_deadline();
    record.extend(world.record.take().unwrap());
    record
}

fn tshark(path: &std::path::Path, arguments: &[&str]) -> Option<String> {
    let output = Command::new("tshark").arg("-r").arg(path).args(arguments).output().ok()?;
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    Some(String::from_utf8(output.stdout).unwrap())
}

#[test]
fn tshark_decodes_a_recording_without_warnings() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("life.pcap");
    fs::write(&path, capture(&life())).unwrap();
    let Some(wrong) = tshark(&path, &["-Y", "_ws.malformed || _ws.expert.severity >= 0x600000"]) else {
        // tshark is not installed. `.ci/run` reports this.
        return;
    };
    assert_eq!(wrong, "");

    let fields = |filter: &str, fields: &[&str]| {
        let mut arguments = vec!["-Y", filter, "-T", "fields", "-E", "separator=;"];
        arguments.extend(fields.iter().flat_map(|field| ["-e", field]));
        let text = tshark(&path, &arguments).unwrap_or_default();
        text.lines().map(str::to_owned).collect::<Vec<_>>()
    };
    let connect = fields(
        "pn_io.block_type == 0x0101",
        &["pn_io.iocr_properties.rtclass", "pn_io.send_clock_factor", "pn_io.reduction_ratio", "pn_io.watchdog_factor"],
    );
    assert_eq!(connect[0], "0x00000002,0x00000002;32,32;16,16;20,20");
    assert_eq!(connect.len(), 3, "one for each connection");
    let set = fields("pn_dcp.service_id == 4 && pn_dcp.service_type == 0", &["pn_dcp.suboption_ip_ip"]);
    assert_eq!(set, ["192.168.78.2"]);
    let data = fields("pn_rt.frame_id == 0x8002 || pn_rt.frame_id == 0x8001", &["pn_rt.ds"]);
    assert!(data.len() > 10 && data.iter().all(|status| status == "0x35"), "{data:?}");
    let errors = fields("pn_io.error_code2", &["pn_io.error_code", "pn_io.error_decode", "pn_io.error_code1"]);
    assert!(errors.iter().any(|error| error == "0xcf;0x81;253"), "{errors:?}");
    let alarms = fields("pn_io.alarm_type == 1", &["pn_io.block_type"]);
    assert_eq!(alarms.len(), 4, "two alarms, each noted: {alarms:?}");
    let modules = fields("pn_io.block_type == 0x8104", &["pn_io.module_ident_number"]);
    assert!(modules[0].contains("0x00000040"), "{modules:?}");
}

#[test]
fn tshark_agrees_with_the_layout() {
    let layout: Layout = "0:1,1:2:i4,2:3:o4".parse().unwrap();
    let device = Setup { layout: layout.clone(), ..setup() };
    let settings = Settings { layout, resting: vec![1, 2, 3, 4], ..settings() };
    let mut world = World::new(device, settings, "");
    world.record = Some(Vec::new());
    world.until(30_000 * MS, |world| world.view().statistics.received > 5);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("data.pcap");
    fs::write(&path, capture(&world.record.take().unwrap())).unwrap();
    let arguments = ["-Y", "pn_rt && pn_io.ioxs", "-T", "fields", "-e", "pn_io.ioxs"];
    let Some(text) = tshark(&path, &arguments) else {
        // tshark is not installed. `.ci/run` reports this.
        return;
    };
    assert!(!text.is_empty());
    let last = text.lines().last().unwrap_or_default();
    assert!(last.split(',').all(|status| status == "0x80"), "{last}");
}
