//! Texts of status codes: encapsulation, CIP, connection manager.

use std::fmt::Write as _;

use super::wire::Status;

/// Description of a status code.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Code {
    /// The code.
    pub code: u32,
    /// Short name.
    pub name: &'static str,
    /// Cause.
    pub cause: &'static str,
    /// Remedy.
    pub remedy: &'static str,
}

/// Encapsulation status codes (volume 2, table 2-3.3).
#[rustfmt::skip] // Six lines per row would hide the table.
pub const ENCAPSULATION: &[Code] = &[
    code(0x00, "success", "The device accepted the message.", "Nothing to do."),
    code(0x01, "invalid or unsupported command", "The device does not support this encapsulation command.",
        "Check that this is the address of an EtherNet/IP device, and that its firmware is not very old."),
    code(0x02, "out of memory", "The device has no memory for the message or the session.",
        "Close sessions of other tools, wait a moment, and try again."),
    code(0x03, "incorrect data", "The data of the message is malformed for the device.",
        "Record the traffic with --trace, and compare it with the manual of the device."),
    code(0x64, "invalid session", "The session does not exist in the device, for example after a restart.",
        "Connect again; armctl does this automatically."),
    code(0x65, "invalid length", "The device expects another message length.",
        "Record the traffic with --trace, and compare it with the manual of the device."),
    code(0x69, "unsupported protocol version", "The device uses another version of the encapsulation.",
        "Check that this is the address of an EtherNet/IP device."),
];

/// CIP general status codes (volume 1, appendix B-1).
#[rustfmt::skip] // Six lines per row would hide the table.
pub const GENERAL: &[Code] = &[
    code(0x00, "success", "The request was carried out.", "Nothing to do."),
    code(0x01, "connection failure",
        "A connection could not be opened, closed or reached; the extended status says why.",
        "Look up the extended status."),
    code(0x02, "resource unavailable", "The device has no memory for the request.",
        "Close connections of other masters and tools, or wait until they time out."),
    code(0x03, "invalid parameter value", "A value of the request is out of range.",
        "Check the values of the request."),
    code(0x04, "path segment error", "The device does not understand a part of the path.",
        "Check class, instance and attribute. For a connection, check the assembly instances (in, out, config)."),
    code(0x05, "path destination unknown", "The device has no such object.",
        "Check class and instance; probe the target to find its assemblies."),
    code(0x06, "partial transfer", "Only a part of the data fits into the answer.",
        "Read the rest in another request."),
    code(0x07, "connection lost", "The connection of the request was lost.", "Open the connection again."),
    code(0x08, "service not supported", "The object does not have this service.",
        "Check the service; many objects allow only a complete read, or only a read of one attribute."),
    code(0x09, "invalid attribute value", "The attribute cannot have this value.", "Check the value and its size."),
    code(0x0A, "attribute list error", "Each attribute of the list has its own status.",
        "Read the attributes one by one."),
    code(0x0B, "already in requested state", "The object is already in the requested mode or state.", "Nothing to do."),
    code(0x0C, "object state conflict",
        "The object cannot do this in its state; an assembly that a connection owns cannot be written.",
        "End the connection that uses the object, for example the connection of a PLC, and try again."),
    code(0x0D, "object already exists", "An object with this number exists.", "Use another instance."),
    code(0x0E, "attribute not settable", "The attribute can only be read.", "Do not write this attribute."),
    code(0x0F, "privilege violation", "The device does not give the client permission for this.",
        "Check the access settings of the device."),
    code(0x10, "device state conflict", "The device cannot do this in its mode.",
        "Check the mode of the device, and whether a master owns it."),
    code(0x11, "reply data too large", "The answer does not fit into a reply.", "Read less data per request."),
    code(0x12, "fragmentation of a value", "The value would be split into two parts.", "Request complete values."),
    code(0x13, "not enough data", "The request is too short.", "Check the size of the data."),
    code(0x14, "attribute not supported", "The object does not have this attribute.",
        "Check the attribute; many devices do not have optional attributes."),
    code(0x15, "too much data", "The request is too long.", "Check the size of the data."),
    code(0x16, "object does not exist", "The device has no such instance.",
        "Check the instance; probe the target to find its assemblies."),
    code(0x17, "no fragmentation in progress", "The first part is missing.", "Start the transfer again."),
    code(0x18, "no stored attribute data", "No saved data exists.", "Save first."),
    code(0x19, "store operation failure", "The device could not save the data.", "Check the memory of the device."),
    code(0x1A, "request too large for the route", "A network on the route allows less data.",
        "Send less data per request."),
    code(0x1B, "reply too large for the route", "A network on the route allows less data.",
        "Read less data per request."),
    code(0x1C, "missing attribute list entry", "A list does not have a required attribute.", "Complete the list."),
    code(0x1D, "invalid attribute list", "The list of attributes is not valid.", "Check the list."),
    code(0x1E, "embedded service error", "A request within the request failed.", "Check the inner status."),
    code(0x1F, "vendor-specific error", "The device reports its own code in the extended status.",
        "Look up the code in the device's manual."),
    code(0x20, "invalid parameter", "A parameter of the service is not valid.", "Check the data of the request."),
    code(0x21, "write-once value already written", "The value can be written only once.", "Nothing to do."),
    code(0x22, "invalid reply", "A device behind this device sent an invalid answer.",
        "Check the devices behind this device."),
    code(0x25, "key failure in path", "The device does not match the electronic key.",
        "Compare the key with the identity of the device, or remove the key."),
    code(0x26, "invalid path size", "The length of the path does not match its content.", "Check the path."),
    code(0x27, "unexpected attribute in list", "An attribute of the list cannot be set now.", "Remove it."),
    code(0x28, "invalid member id", "The object has no such member.", "Check the member."),
    code(0x29, "member not settable", "The member can only be read.", "Do not write this member."),
];

/// Extended status codes of the connection manager, with general status 0x01 (volume 1, table 3-5.29).
#[rustfmt::skip] // Six lines per row would hide the table.
pub const CONNECTION: &[Code] = &[
    code(0x0100, "connection in use or duplicate open",
        "The device still has an earlier connection with the same serial numbers.",
        "Wait until that connection times out in the device (at most 10 s), then try again."),
    code(0x0103, "transport class or trigger not supported",
        "The device does not support this connection class or trigger.",
        "Check that the device has cyclic (class 1) connections."),
    code(0x0106, "ownership conflict", "Another master owns the outputs, or a dead connection has not timed out yet.",
        "Find the PLC or session that owns the device. End its connection, or wait until the connection times out."),
    code(0x0107, "connection not found", "The device does not have this connection, or the connection has timed out.",
        "At a close, do nothing; otherwise, open the connection again."),
    code(0x0108, "invalid connection type",
        "The device does not support this connection type (point to point, multicast).",
        "Set `multicast=` in the URL to the other value (yes or no)."),
    code(0x0109, "invalid connection size",
        "The sizes do not match the device's assemblies; the next word is the correct size.",
        "Set the sizes that a probe of the target finds."),
    code(0x0110, "device not configured", "The device has no configuration yet.",
        "Check the configuration instance, and the settings of the network unit."),
    code(0x0111, "RPI not supported", "The device does not support this packet interval.",
        "Set another `rpi=` in the URL; 10 ms to 100 ms are usual."),
    code(0x0112, "RPI not acceptable",
        "The device cannot keep this packet interval; the next words may give a valid interval.",
        "Set a longer `rpi=` in the URL."),
    code(0x0113, "out of connections", "All connections of the device are in use.",
        "Close the connections of other masters and tools, or wait until they time out."),
    code(0x0114, "vendor or product code mismatch", "The device does not match the electronic key.",
        "Compare the key with the identity of the device, or remove the key."),
    code(0x0115, "device type mismatch", "The type of the device does not match the electronic key.",
        "Compare the key with the identity of the device, or remove the key."),
    code(0x0116, "revision mismatch", "The revision of the device differs from the electronic key.",
        "Compare the key with the identity of the device, allow compatible revisions, or remove the key."),
    code(0x0117, "invalid connection point",
        "The device has no such assembly, or the assembly is not for this direction.",
        "Swap `in=` and `out=` in the URL, or probe the target to find its assemblies."),
    code(0x0118, "invalid configuration",
        "The device expects another configuration instance or other configuration data.",
        "Set another `config=` instance in the URL; the usual values are 1 and `none`."),
    code(0x0119, "no controlling connection", "A listen-only connection needs an owner connection.",
        "Open an owner connection first, or use input only."),
    code(0x011A, "target out of connections", "All connections of the device are in use.",
        "Close the connections of other masters and tools, or wait until they time out."),
    code(0x011B, "RPI below the production inhibit time", "The device cannot send at this short interval.",
        "Set a longer `rpi=` in the URL."),
    code(0x011C, "transport class not supported", "The device does not offer cyclic connections.", "Check the device."),
    code(0x011D, "production trigger not supported", "The device does not send cyclically.", "Check the device."),
    code(0x011E, "direction not supported", "The device does not offer this direction.", "Check the device."),
    code(0x011F, "invalid O->T fixed or variable",
        "The device needs the other size type (fixed or variable) for its outputs.",
        "Probe the target; report this device to the developers of armctl."),
    code(0x0120, "invalid T->O fixed or variable",
        "The device needs the other size type (fixed or variable) for its inputs.",
        "Probe the target; report this device to the developers of armctl."),
    code(0x0121, "invalid O->T priority", "The device does not offer this priority.",
        "Report this device to the developers of armctl."),
    code(0x0122, "invalid T->O priority", "The device does not offer this priority.",
        "Report this device to the developers of armctl."),
    code(0x0123, "invalid O->T connection type", "The device does not accept its outputs with this connection type.",
        "Report this device to the developers of armctl; point to point is usual."),
    code(0x0124, "invalid T->O connection type", "The device does not send its inputs with this connection type.",
        "Set `multicast=` in the URL to the other value (yes or no)."),
    code(0x0125, "invalid redundant owner", "The device has at most one owner.",
        "Report this device to the developers of armctl."),
    code(0x0126, "invalid configuration size",
        "The size of the configuration data is wrong; the next word is the correct size, as a number of words.",
        "Remove the configuration data, or set the data that the device expects."),
    code(0x0127, "invalid O->T size", "The size of the output image is wrong; the next word is the correct size.",
        "Set the sizes that a probe of the target finds."),
    code(0x0128, "invalid T->O size", "The size of the input image is wrong; the next word is the correct size.",
        "Set the sizes that a probe of the target finds."),
    code(0x0129, "invalid configuration path", "The device has no such configuration instance.",
        "Set another `config=` instance in the URL; the usual values are 1 and `none`."),
    code(0x012A, "invalid consuming path", "The device has no such assembly for its outputs.",
        "Swap `in=` and `out=` in the URL, or probe the target to find its assemblies."),
    code(0x012B, "invalid producing path", "The device has no such assembly for its inputs.",
        "Swap `in=` and `out=` in the URL, or probe the target to find its assemblies."),
    code(0x012C, "configuration symbol not known", "The path contains a name that the device does not have.",
        "Use numbers."),
    code(0x012D, "consuming symbol not known", "The path contains a name that the device does not have.",
        "Use numbers."),
    code(0x012E, "producing symbol not known", "The path contains a name that the device does not have.",
        "Use numbers."),
    code(0x012F, "inconsistent path combination", "The assemblies exist, but not in this combination.",
        "Swap `in=` and `out=` in the URL, or probe the target to find its assemblies."),
    code(0x0130, "inconsistent consumed data", "The data formats do not match.", "Probe the target."),
    code(0x0131, "inconsistent produced data", "The data formats do not match.", "Probe the target."),
    code(0x0203, "connection timed out", "The connection had no traffic for too long.",
        "Open the connection again; check the cables and the load of the network."),
    code(0x0204, "unconnected request timed out", "A device behind this device did not answer.",
        "Check the devices behind this device."),
    code(0x0205, "bad parameter in unconnected request", "A timeout or a path is not valid.", "Check the request."),
    code(0x0206, "message too large", "The message is too large for the unconnected service.",
        "Send less data per request."),
    code(0x0207, "unconnected acknowledge without reply", "The device acknowledged the request, but did not answer it.",
        "Try again."),
    code(0x0301, "no buffer memory", "The device has no free buffer.", "Close connections, wait, and try again."),
    code(0x0302, "bandwidth not available", "The network has no free bandwidth for this interval.",
        "Set a longer `rpi=` in the URL."),
    code(0x0303, "no consumed connection id available", "The device has no free connection ID.",
        "Close other connections."),
    code(0x0304, "not configured to send scheduled data", "The network is not scheduled.", "Check the network."),
    code(0x0305, "schedule signature mismatch", "The schedule changed.", "Check the network."),
    code(0x0311, "port not available", "The path uses a port that does not exist.", "Remove the route."),
    code(0x0312, "link address not valid", "The path contains an address behind a port that does not exist.",
        "Check it."),
    code(0x0315, "invalid segment in connection path", "The device does not understand the path.",
        "Remove the key and the configuration, or change the instances."),
    code(0x0316, "error in close path", "The path differs from the path of the open request.",
        "Wait until the connection times out."),
    code(0x0317, "scheduling not specified", "The network needs a schedule.", "Check the network."),
    code(0x0318, "link address to self", "The path leads back to the device.", "Remove the route."),
    code(0x0319, "secondary resources unavailable", "The redundant device has no free resources.", "Check the device."),
    code(0x031A, "rack connection already open", "A connection to the whole rack uses the module.",
        "Close that connection."),
    code(0x031B, "module connection already open", "A connection to a module of the rack is open.",
        "Close that connection."),
    code(0x031C, "miscellaneous", "The device reports its own code.", "See the device's manual."),
    code(0x031D, "redundant connection mismatch", "The redundant owners request different connection parameters.",
        "Check the owners."),
    code(0x031E, "no more consumers", "All links of the producer are in use.", "Close other connections."),
    code(0x031F, "no configuration for the path", "The producer is not configured.", "Check its configuration."),
    code(0x0800, "network link offline", "A network on the route is down.", "Check the network."),
    code(0x0810, "no target application data", "The device has no data to send yet.", "Start its application."),
    code(0x0811, "no originator application data", "The originator has no data to send yet.", "Try again."),
    code(0x0813, "not configured for off-subnet multicast", "Multicast does not cross routers here.",
        "Set `multicast=no` in the URL."),
];

/// Description of an encapsulation status.
pub fn encapsulation(status: u32) -> Option<&'static Code> {
    find(ENCAPSULATION, status)
}

/// Description of a general status.
pub fn general(status: u8) -> Option<&'static Code> {
    find(GENERAL, status.into())
}

/// Description of an extended status with general status 0x01.
pub fn connection(extended: u16) -> Option<&'static Code> {
    find(CONNECTION, extended.into())
}

/// Description of a status. If the status has an extended code, the description of this code.
pub fn meaning(status: &Status) -> Option<&'static Code> {
    let extended = status.extended.first().filter(|_| status.general == 1);
    extended.and_then(|extended| connection(*extended)).or_else(|| general(status.general))
}

/// One-line text, for example "invalid connection size (0x01/0x0109), the right one is 54 bytes".
pub fn describe(status: &Status) -> String {
    let mut text = meaning(status).map_or("an unknown status", |code| code.name).to_owned();
    // Writing to a string cannot fail.
    let _ = write!(text, " ({:#04x}", status.general);
    if let Some(extended) = status.extended.first() {
        let _ = write!(text, "/{extended:#06x}");
    }
    text.push(')');
    if let (1, [0x0109 | 0x0127 | 0x0128, right, ..]) = (status.general, &status.extended[..]) {
        let _ = write!(text, ", the correct size is {right} bytes");
    }
    text
}

const fn code(code: u32, name: &'static str, cause: &'static str, remedy: &'static str) -> Code {
    Code { code, name, cause, remedy }
}

fn find(codes: &'static [Code], code: u32) -> Option<&'static Code> {
    codes.binary_search_by_key(&code, |row| row.code).ok().and_then(|index| codes.get(index))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_are_in_order() {
        for table in [ENCAPSULATION, GENERAL, CONNECTION] {
            assert!(table.is_sorted_by(|one, next| one.code < next.code));
            assert!(table.iter().all(|row| row.cause.ends_with('.') && row.remedy.ends_with('.')));
        }
    }

    #[test]
    fn describes_statuses_in_one_line() {
        let size = Status::connection(0x0109, &[54]);
        assert_eq!(describe(&size), "invalid connection size (0x01/0x0109), the correct size is 54 bytes");
        assert_eq!(describe(&Status::general(0x16)), "object does not exist (0x16)");
        assert_eq!(describe(&Status { general: 0xD0, extended: vec![7] }), "an unknown status (0xd0/0x0007)");
        assert_eq!(meaning(&Status::connection(0x7777, &[])).unwrap().name, "connection failure");
    }
}
