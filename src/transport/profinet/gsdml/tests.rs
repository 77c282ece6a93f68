//! Tests with files of another author, with files of this project, and with broken files.

use pnio::config::{DeviceConfig, Slot};
use pnio::data::FieldType;
use pnio::gsdml::{GsdmlMeta, render};
use proptest::prelude::*;

use super::*;

fn file(inputs: usize, outputs: usize) -> String {
    let config = DeviceConfig::builder("yrcx-sim")
        .identity(0xFFFF, 0x1234)
        .min_device_interval(32)
        .input(Slot(1), &vec![FieldType::Word; inputs])
        .output(Slot(2), &vec![FieldType::Word; outputs])
        .build()
        .unwrap();
    let text = |text: &str| text.to_owned();
    let meta =
        GsdmlMeta { vendor_name: text("a"), product_family: text("b"), info_text: text("c"), date: (2026, 1, 2) };
    render(&config, &meta)
}

/// The crate `pnio` writes a file for a layout. If this file is parsed, the result must be the same layout.
#[test]
fn layout_of_a_foreign_file_matches_its_device() {
    let gsdml = Gsdml::parse(file(24, 24).as_bytes()).unwrap();
    assert_eq!((gsdml.vendor, gsdml.device, gsdml.heads.len()), (0xFFFF, 0x1234, 1));
    let head = &gsdml.heads[0];
    assert_eq!((head.ident, head.instance, head.shortest, head.startup), (1, 1, 32, (true, false)));
    let chosen = head.choose(48, 48).unwrap();
    assert_eq!(chosen.iter().map(|(slot, _)| *slot).collect::<Vec<_>>(), [1, 2]);
    assert_eq!(head.layout(&chosen), Ok(Layout::two_modules(0x101, 0x102)));
    assert_eq!(head.parameters(&chosen), Ok(Vec::new()));
    assert_eq!(head.choose(46, 48), None);
    let swapped = [(2, chosen[0].1)];
    assert!(head.layout(&swapped).unwrap_err().contains("is not possible in slot 2"));
}

const OWN: &str = r#"<?xml version="1.0" encoding="iso-8859-1"?>
<ISO15745Profile xmlns="http://www.profibus.com/GSDML/2003/11/DeviceProfile"><ProfileBody>
<DeviceIdentity VendorID="0x0123" DeviceID="77"/>
<ApplicationProcess><DeviceAccessPointList>
<DeviceAccessPointItem ID="D" ModuleIdentNumber="0x10" PhysicalSlots="0..3" MinDeviceInterval="32" DNS_CompatibleName="x">
<ModuleInfo><Name TextId="T"/></ModuleInfo>
<UseableModules>
<ModuleItemRef ModuleItemTarget="M" FixedInSlots="1"/><ModuleItemRef ModuleItemTarget="N"/>
</UseableModules>
<VirtualSubmoduleList><VirtualSubmoduleItem ID="S" SubmoduleIdentNumber="1"><IOData/></VirtualSubmoduleItem></VirtualSubmoduleList>
</DeviceAccessPointItem></DeviceAccessPointList>
<ModuleList>
<ModuleItem ID="M" ModuleIdentNumber="0x40"><VirtualSubmoduleList>
<VirtualSubmoduleItem ID="MS" SubmoduleIdentNumber="2"><IOData>
<Input><DataItem DataType="OctetString" Length="48"/></Input><Output><DataItem DataType="Unsigned16"/><DataItem DataType="OctetString" Length="46"/></Output>
</IOData><RecordDataList>
<ParameterRecordDataItem Index="5" Length="8"><Const Data="0x01,0x02"/>
<Ref ByteOffset="2" DataType="Unsigned16" DefaultValue="258"/><Ref ByteOffset="4" DataType="Bit" BitOffset="3" DefaultValue="1"/>
<Ref ByteOffset="4" DataType="BitArea" BitOffset="0" BitLength="2" DefaultValue="2"/><Ref ByteOffset="5" DataType="Integer8" DefaultValue="-2"/>
</ParameterRecordDataItem></RecordDataList></VirtualSubmoduleItem></VirtualSubmoduleList></ModuleItem>
<ModuleItem ID="N" ModuleIdentNumber="0x41"><VirtualSubmoduleList/></ModuleItem>
</ModuleList>
<ExternalTextList><PrimaryLanguage><Text TextId="T" Value="Unit &#228;"/></PrimaryLanguage></ExternalTextList>
</ApplicationProcess></ProfileBody></ISO15745Profile>
"#;

#[test]
fn fixed_modules_parameters_and_names_are_read() {
    let gsdml = Gsdml::parse(OWN.as_bytes()).unwrap();
    let head = &gsdml.heads[0];
    assert_eq!((gsdml.vendor, gsdml.device, head.name.as_str()), (0x123, 77, "Unit ä"));
    assert_eq!(head.startup, (false, true), "legacy, where nothing is said");
    assert_eq!(head.modules[1].slots, [1, 2, 3]);
    let chosen = head.choose(48, 48).unwrap();
    assert_eq!(head.layout(&chosen).unwrap().to_string(), "0:0x10,1:0x40/0x2:i48o48");
    let data = vec![1, 2, 1, 2, 0x0A, 0xFE, 0, 0];
    assert_eq!(head.parameters(&chosen), Ok(vec![Parameter { slot: 1, subslot: 1, index: 5, data }]));
    // The file contains one byte that is not valid in UTF-8.
    let latin: Vec<u8> =
        OWN.replace("&#228;", "\u{1}").bytes().map(|byte| if byte == 1 { 0xE4 } else { byte }).collect();
    assert_eq!(Gsdml::parse(&latin).unwrap(), gsdml);
}

/// A module that the device always has must not be selected again.
#[test]
fn selects_a_fixed_module_once() {
    let two = OWN.replace(
        "<Output><DataItem DataType=\"Unsigned16\"/><DataItem DataType=\"OctetString\" Length=\"46\"/></Output>",
        "",
    );
    let two = two.replace(
        "<VirtualSubmoduleList/>",
        "<VirtualSubmoduleList><VirtualSubmoduleItem ID=\"NS\" SubmoduleIdentNumber=\"1\"><IOData><Output>\
         <DataItem DataType=\"OctetString\" Length=\"48\"/></Output></IOData></VirtualSubmoduleItem></VirtualSubmoduleList>",
    );
    let gsdml = Gsdml::parse(two.as_bytes()).unwrap();
    let head = &gsdml.heads[0];
    let layout = head.layout(&head.choose(48, 48).unwrap()).unwrap();
    assert_eq!(layout.size(Direction::Output), 48);
}

#[test]
fn a_referenced_submodule_is_found_by_its_id() {
    let listed = "<SubmoduleItem ID=\"A\" SubmoduleIdentNumber=\"7\"><IOData/></SubmoduleItem>\
                  <SubmoduleItem ID=\"B\" SubmoduleIdentNumber=\"8\"><IOData/></SubmoduleItem>";
    let refer = |id: &str| {
        let used = format!("<UseableSubmodules><SubmoduleItemRef SubmoduleItemTarget=\"{id}\" FixedInSubslots=\"3\"/>");
        let file = OWN.replace("<VirtualSubmoduleList/>", &format!("{used}</UseableSubmodules>"));
        Gsdml::parse(
            file.replace("</ModuleList>", &format!("</ModuleList><SubmoduleList>{listed}</SubmoduleList>")).as_bytes(),
        )
    };
    let gsdml = refer("B").unwrap();
    let [found] = &gsdml.heads[0].modules[1].module.submodules[..] else { panic!("{gsdml:?}") };
    assert_eq!((found.subslot, found.ident), (3, 8));
    assert!(refer("C").unwrap_err().problem.contains("SubmoduleItem 'C' is missing"));
}

#[test]
fn errors_have_line_and_element() {
    let cases = [
        ("VendorID=\"0x0123\"", "", 3, "DeviceIdentity", "VendorID is missing"),
        ("DeviceID=\"77\"", "DeviceID=\"70000\"", 3, "DeviceIdentity", "above 65535"),
        ("ModuleIdentNumber=\"0x40\"", "ModuleIdentNumber=\"x\"", 14, "ModuleItem", "not a number: 'x'"),
        ("ModuleItemTarget=\"N\"", "ModuleItemTarget=\"Q\"", 8, "ModuleItemRef", "ModuleItem 'Q' is missing"),
        ("DataType=\"Unsigned16\"/", "DataType=\"Blob\"/", 16, "DataItem", "'Blob' is unknown"),
        ("PhysicalSlots=\"0..3\"", "PhysicalSlots=\"a..3\"", 5, "DeviceAccessPointItem", "not a valid list of numbers"),
        ("FixedInSlots=\"1\"", "FixedInSlots=\"0..65535 0..65535\"", 8, "ModuleItemRef", "more than 4096"),
        ("ID=\"MS\"", "FixedInSubslots=\"1..600\"", 15, "VirtualSubmoduleItem", "at most 512 submodules are possible"),
        ("Data=\"0x01,0x02\"", "Data=\"0x01,0x200\"", 18, "Const", "is not a list of bytes"),
        ("ByteOffset=\"5\"", "ByteOffset=\"8\"", 20, "Ref", "does not fit in the record"),
        ("DefaultValue=\"258\"", "DefaultValue=\"65536000\"", 19, "Ref", "is not a valid Unsigned16"),
        ("</ModuleList>", "", 24, "file", "not XML"),
    ];
    for (from, to, line, element, problem) in cases {
        let broken = OWN.replacen(from, to, 1);
        assert_ne!(broken, OWN, "{from}");
        let error = Gsdml::parse(broken.as_bytes()).unwrap_err();
        assert!(error.problem.contains(problem), "{from}: {error}");
        assert_eq!(error.element, element, "{from}: {error}");
        assert!(error.line.abs_diff(line) <= 1, "{from}: {error}");
    }
    assert!(Gsdml::parse(b"").is_err());
    let bomb = "<!DOCTYPE a [<!ENTITY b \"c\">]><a>&b;</a>";
    assert!(Gsdml::parse(bomb.as_bytes()).unwrap_err().problem.contains("not XML"));
}

proptest! {
    #[test]
    fn damaged_files_are_read_without_a_panic(at in 0usize..3000, byte in any::<u8>(), cut in 0usize..4000) {
        let mut bytes = OWN.as_bytes().to_vec();
        if let Some(place) = bytes.get_mut(at) {
            *place = byte;
        }
        bytes.truncate(cut);
        if let Ok(gsdml) = Gsdml::parse(&bytes) {
            for head in &gsdml.heads {
                let _ = head.choose(48, 48).map(|chosen| (head.layout(&chosen), head.parameters(&chosen)));
            }
        }
    }
}
