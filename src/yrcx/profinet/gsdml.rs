//! `yrcx profinet gsdml`.

use crate::prelude::*;
use armctl_frame::OfflineCommand;
use armctl_transport::profinet::gsdml::{self, Gsdml, Head, SlottedModule};
use armctl_transport::profinet::layout::Direction;

/// Reads the GSDML file of a device: its modules, and the layout for a target. This needs no robot.
#[derive(Debug, Args)]
#[command(
    after_help = "armctl reports an error in the file with its line and element (exit code 2). The layout uses the \
                  modules with 48 bytes each way, as on a YRCX. If several layouts are possible, write the layout \
                  into the target yourself; see `armctl help profinet`."
)]
pub struct ReadFile {
    /// GSDML file, for example GSDML-V2.35-….xml
    #[arg(value_name = "FILE")]
    file: PathBuf,
}

impl OfflineCommand for ReadFile {
    type Report = DeviceDescription;
    const ID: &'static str = "yrcx.profinet.gsdml";

    fn run(&self, _screen: &Screen) -> Result<DeviceDescription> {
        let shown = self.file.display();
        let bytes = files::read(&self.file, gsdml::MAX_FILE_SIZE).map_err(|error| Failure::io(&shown, &error))?;
        let read = Gsdml::parse(&bytes).map_err(|error| {
            Failure::usage(format!("{shown}: {error}")).hint("check that the file is the GSDML file of the device")
        })?;
        Ok(DeviceDescription::from(&read))
    }
}

/// Device description by the manufacturer. Do not trust the names.
#[derive(Debug, Serialize, JsonSchema)]
pub struct DeviceDescription {
    /// Vendor id, for example `0x0123`.
    vendor: String,
    /// Device id, for example `0x0001`.
    device: String,
    /// Access points that slot 0 can contain. A device has one of them.
    access_points: Vec<AccessPoint>,
}

/// An access point.
#[derive(Debug, Serialize, JsonSchema)]
struct AccessPoint {
    /// ID in the file.
    id: String,
    name: String,
    /// Default station name; empty if there is none.
    station: String,
    /// Ident number, for example `0x1`.
    ident: String,
    /// Start-up modes that the access point supports: `advanced`, `legacy`.
    startup: Vec<&'static str>,
    /// Minimum cycle time in us.
    cycle_us: u32,
    modules: Vec<Module>,
    /// Value of `layout=` for a target with images of 48 bytes each way; null unless exactly one selection of modules
    /// has this size.
    layout: Option<String>,
    /// Number of start-up parameter records that this layout needs.
    parameters: Option<usize>,
}

/// A module that the access point allows.
#[derive(Debug, Serialize, JsonSchema)]
struct Module {
    /// ID in the file.
    id: String,
    name: String,
    /// Ident number, for example `0x101`.
    ident: String,
    /// Slots in which the module is allowed.
    slots: Vec<u16>,
    /// Slots that always contain the module.
    fixed: Vec<u16>,
    /// Number of bytes from the device.
    in_size: usize,
    /// Number of bytes to the device.
    out_size: usize,
}

impl From<&Gsdml> for DeviceDescription {
    fn from(read: &Gsdml) -> Self {
        Self {
            vendor: format!("{:#06x}", read.vendor),
            device: format!("{:#06x}", read.device),
            access_points: read.heads.iter().map(AccessPoint::from).collect(),
        }
    }
}

impl From<&Head> for AccessPoint {
    fn from(head: &Head) -> Self {
        let chosen = head.choose(Image::BYTES, Image::BYTES);
        let modes = [("advanced", head.startup.0), ("legacy", head.startup.1)];
        Self {
            id: head.id.clone(),
            name: head.name.clone(),
            station: head.dns_name.clone(),
            ident: format!("{:#x}", head.ident),
            startup: modes.into_iter().filter(|(_, has)| *has).map(|(mode, _)| mode).collect(),
            // The unit in the file is 31.25 us.
            cycle_us: u32::from(head.shortest) * 125 / 4,
            modules: head.modules.iter().map(Module::from).collect(),
            layout: chosen.as_ref().and_then(|chosen| head.layout(chosen).ok()).map(|layout| layout.to_string()),
            parameters: chosen.as_ref().and_then(|chosen| head.parameters(chosen).ok()).map(|records| records.len()),
        }
    }
}

impl From<&SlottedModule> for Module {
    fn from(fitting: &SlottedModule) -> Self {
        Self {
            id: fitting.module.id.clone(),
            name: fitting.module.name.clone(),
            ident: format!("{:#x}", fitting.module.ident),
            slots: fitting.slots.clone(),
            fixed: fitting.fixed.clone(),
            in_size: fitting.module.size(Direction::Input),
            out_size: fitting.module.size(Direction::Output),
        }
    }
}

impl Report for DeviceDescription {
    fn view(&self) -> View {
        let device = vec![("vendor", self.vendor.as_str().into()), ("device", self.device.as_str().into())];
        let mut view = View::default().append(Section::Fields(device));
        for head in &self.access_points {
            let known = |text: &str| Cell::optional((!text.is_empty()).then_some(text));
            view = view.append(Section::Fields(vec![
                ("access point", head.id.as_str().into()),
                ("name", known(&head.name)),
                ("ident", head.ident.as_str().into()),
                ("station", known(&head.station)),
                ("startup", head.startup.join(", ").into()),
                ("shortest cycle", format!("{} us", head.cycle_us).into()),
                ("layout", Cell::optional(head.layout.as_deref())),
                ("parameters", Cell::optional(head.parameters.map(|count| format!("{count} records")))),
            ]));
            let columns = ["module", "name", "ident", "slots", "from device", "to device"];
            let mut table = Table::new(&columns, "no modules");
            for module in &head.modules {
                let always = if module.fixed.is_empty() { "" } else { " (always there)" };
                table.row([
                    module.id.as_str().into(),
                    known(&module.name),
                    Cell::from(module.ident.as_str()).whole(),
                    format!("{}{always}", ranges(&module.slots)).into(),
                    module.in_size.into(),
                    module.out_size.into(),
                ]);
            }
            view = view.append(Section::Table(table));
        }
        view
    }
}

/// Formats slots as ranges, for example `1 to 4, 7`.
fn ranges(slots: &[u16]) -> String {
    let mut ranges: Vec<(u16, u16)> = Vec::new();
    for slot in slots {
        match ranges.last_mut() {
            Some((_, last)) if last.checked_add(1) == Some(*slot) => *last = *slot,
            _ => ranges.push((*slot, *slot)),
        }
    }
    let shown =
        ranges.iter().map(|(first, last)| if first == last { first.to_string() } else { format!("{first} to {last}") });
    shown.collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formats_consecutive_slots_as_a_range() {
        assert_eq!(ranges(&[1, 2, 3, 7, 9, 10]), "1 to 3, 7, 9 to 10");
        assert_eq!((ranges(&[]), ranges(&[u16::MAX])), (String::new(), "65535".to_owned()));
    }
}
