//! Report of a PROFINET station.

use crate::prelude::basics::*;
use armctl_transport::profinet::commission::StationInfo;
use armctl_transport::profinet::wire::dcp;

/// A station. Do not trust its texts.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, JsonSchema)]
pub struct Station {
    /// Station name; empty if there is none.
    pub station: String,
    /// MAC address.
    pub mac: String,
    /// Type of the station, as the station reports it.
    pub kind: String,
    /// Vendor id, for example `0x0123`.
    pub vendor: Option<String>,
    /// Device id, for example `0x0001`.
    pub device: Option<String>,
    /// Roles of the station: `device`, `controller`, `multidevice`, `supervisor`.
    pub roles: Vec<&'static str>,
    /// IP address; null if there is none.
    pub ip: Option<String>,
    /// Subnet mask; null if there is no address.
    pub mask: Option<String>,
    /// Gateway; null if there is none.
    pub gateway: Option<String>,
    /// Problems, for example a name or address that another station has too.
    pub remarks: Vec<String>,
}

/// Names of the role bits.
const ROLES: [&str; 4] = ["device", "controller", "multidevice", "supervisor"];

impl From<&StationInfo> for Station {
    fn from(found: &StationInfo) -> Self {
        let said = &found.station;
        let suite = said.ip.filter(|(suite, _)| !suite.address.is_unspecified());
        let mut remarks = Vec::new();
        if suite.is_some_and(|(_, origin)| origin.is_in_conflict()) {
            remarks.push("the station reports a duplicate address".to_owned());
        }
        if suite.is_some_and(|(_, origin)| origin.is_by_dhcp()) {
            remarks.push("the address is from DHCP".to_owned());
        }
        let is_gateway = |suite: &dcp::IpSuite| !suite.gateway.is_unspecified() && suite.gateway != suite.address;
        Self {
            station: said.name.clone(),
            mac: found.mac.to_string(),
            kind: said.kind.clone(),
            vendor: said.id.map(|(vendor, _)| format!("{vendor:#06x}")),
            device: said.id.map(|(_, device)| format!("{device:#06x}")),
            roles: (0..).zip(ROLES).filter(|(bit, _)| said.role >> bit & 1 == 1).map(|(_, role)| role).collect(),
            ip: suite.map(|(suite, _)| suite.address.to_string()),
            mask: suite.map(|(suite, _)| suite.mask.to_string()),
            gateway: suite.filter(|(suite, _)| is_gateway(suite)).map(|(suite, _)| suite.gateway.to_string()),
            remarks,
        }
    }
}

impl Station {
    /// Converts all stations of a network. Adds a remark if several stations have the same name or address.
    pub fn all(found: &[StationInfo]) -> Vec<Self> {
        let mut all: Vec<Self> = found.iter().map(Self::from).collect();
        for at in 0..all.len() {
            let one = all[at].clone();
            let others = || all.iter().enumerate().filter(|(other, _)| *other != at).map(|(_, other)| other);
            let name = others().find(|other| !one.station.is_empty() && other.station == one.station);
            let address = others().find(|other| one.ip.is_some() && other.ip == one.ip);
            let remarks: Vec<String> = [(name, "name"), (address, "address")]
                .into_iter()
                .filter_map(|(other, what)| Some(format!("{} has the same {what}", other?.mac)))
                .collect();
            all[at].remarks.extend(remarks);
        }
        all
    }

    /// Fields of a view.
    pub fn fields(&self) -> Vec<(&'static str, Cell)> {
        let known = |text: &str| Cell::optional((!text.is_empty()).then_some(text));
        let mut fields = vec![
            ("station", known(&self.station)),
            ("card", self.mac.as_str().into()),
            ("kind", known(&self.kind)),
            ("vendor", Cell::optional(self.vendor.as_deref())),
            ("device", Cell::optional(self.device.as_deref())),
            ("roles", known(&self.roles.join(", "))),
            ("IP", Cell::optional(self.ip.as_deref())),
            ("mask", Cell::optional(self.mask.as_deref())),
            ("gateway", Cell::optional(self.gateway.as_deref())),
        ];
        fields.extend(self.remarks.iter().map(|remark| ("remark", Cell::from(remark.as_str()).tone(Tone::Warning))));
        fields
    }

    /// Describes the station in one line, for example `YRCX simulator, 0xffff:0x0001, 02:00:00:00:00:02`.
    pub fn in_a_line(&self) -> String {
        let id = self.vendor.iter().zip(&self.device).map(|(vendor, device)| format!("{vendor}:{device}"));
        let mut parts: Vec<String> =
            [self.kind.clone()].into_iter().filter(|kind| !kind.is_empty()).chain(id).collect();
        parts.push(self.mac.clone());
        parts.extend(self.remarks.iter().cloned());
        parts.join(", ")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use armctl_transport::profinet::wire::Mac;
    use armctl_transport::profinet::wire::dcp::{IpOrigin, Station as IntoReport};

    fn found(last: u8, name: &str, ip: u8) -> StationInfo {
        let address = [192, 168, 0, ip].into();
        let suite = dcp::IpSuite { address, mask: [255, 255, 255, 0].into(), gateway: address };
        let ip = Some((suite, IpOrigin(1)));
        let station = IntoReport { name: name.to_owned(), role: 9, id: Some((0x123, 4)), ip, ..IntoReport::default() };
        StationInfo { mac: Mac([2, 0, 0, 0, 0, last]), station }
    }

    #[test]
    fn remarks_duplicates_at_both_stations() {
        let all = Station::all(&[found(1, "a", 5), found(2, "a", 6), found(3, "", 5), found(4, "", 7)]);
        let remarks: Vec<_> = all.iter().map(|station| station.remarks.join("; ")).collect();
        assert_eq!(remarks[0], "02:00:00:00:00:02 has the same name; 02:00:00:00:00:03 has the same address");
        assert_eq!(remarks[1], "02:00:00:00:00:01 has the same name");
        assert_eq!(remarks[2], "02:00:00:00:00:01 has the same address");
        assert_eq!(remarks[3], "", "no name is not the same name");
    }

    #[test]
    fn describes_numbers_and_roles() {
        let station = Station::from(&found(1, "a", 5));
        assert_eq!(station.roles, ["device", "supervisor"]);
        let (ip, gateway) = (station.ip.as_deref(), station.gateway);
        assert_eq!((ip, gateway), (Some("192.168.0.5"), None), "its own address is not a duplicate");
        assert_eq!(station.vendor.as_deref(), Some("0x0123"));
    }
}
