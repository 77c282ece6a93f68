//! The targets. A parser that reads bytes from outside belongs to one of them (CONTRIBUTING.md, "Fuzz a parser").

mod devicenet;
mod eip;
mod files;
mod peers;
mod profibus;
mod profinet;
mod toyo;
mod yerc;
mod yrcx;

use std::time::Duration;

use crate::{Target, links, seeds};
use links::Disturbance;

macro_rules! targets {
    ($($name:ident: $run:expr, $seeds:expr, $cases:literal;)*) => {
        /// All targets.
        pub const TARGETS: &[Target] = &[
            $(Target { name: stringify!($name), run: $run, seeds: $seeds, cases: $cases },)*
        ];

        #[cfg(test)]
        mod tests {
            use super::*;

            $(#[test]
            fn $name() {
                Target::named(stringify!($name)).expect("it is in the table").check();
            })*
        }
    };
}

// Name, function, seeds, mutations in `cargo test`. `tests/fuzz/guided` reads the names from these lines.
targets! {
    yerc_frame: yerc::frame, seeds::yerc, 2000;
    yerc_payload: yerc::payload, seeds::yerc_data, 2000;
    yerc_names: yerc::name_file, yerc::name_files, 1000;
    yerc_job: yerc::job, yerc::jobs, 1000;
    yerc_text: yerc::text, yerc::texts, 2000;
    yerc_server: yerc::server, yerc::server_scripts, 200;
    yerc_link: |data| links::yerc(&mut Disturbance::new(data)), seeds::disturbances, 100;
    toyo_line: toyo::line, seeds::toyo, 2000;
    toyo_program: toyo::program, toyo::programs, 1000;
    toyo_server: toyo::server, toyo::server_scripts, 200;
    toyo_link: |data| links::toyo(&mut Disturbance::new(data)), seeds::disturbances, 100;
    yrcx_words: yrcx::words, seeds::yrcx, 2000;
    yrcx_text: yrcx::text, yrcx::texts, 1000;
    yrcx_server: yrcx::server, seeds::yrcx, 200;
    eip_frame: eip::frame, || seeds::traffic(links::eip), 2000;
    eip_server: eip::server, eip::server_scripts, 500;
    eip_link: |data| links::eip(&mut Disturbance::new(data)), seeds::disturbances, 100;
    can_text: devicenet::text, devicenet::texts, 2000;
    devicenet_frame: devicenet::frame, || seeds::traffic(links::devicenet), 2000;
    devicenet_link: |data| links::devicenet(&mut Disturbance::new(data)), seeds::disturbances, 100;
    profibus_telegram: profibus::telegram, || seeds::traffic(links::profibus), 2000;
    profibus_gsd: profibus::gsd, profibus::gsd_files, 1000;
    profibus_link: |data| links::profibus(&mut Disturbance::new(data)), seeds::disturbances, 100;
    profinet_frame: profinet::frame, || seeds::traffic(links::profinet), 2000;
    profinet_rpc: profinet::rpc, || seeds::traffic(links::profinet), 2000;
    profinet_gsdml: profinet::gsdml, profinet::gsdml_files, 300;
    profinet_text: profinet::text, profinet::texts, 1000;
    profinet_link: |data| links::profinet(&mut Disturbance::new(data)), seeds::disturbances, 100;
    capture: files::capture, files::captures, 300;
    inventory: files::inventory, files::inventories, 300;
    table: files::table, files::tables, 500;
    simulator_file: files::simulator_file, files::simulator_files, 200;
    backup: files::backup, files::backups, 40;
    batch_line: files::batch_line, files::batch_lines, 1000;
    typed_text: files::typed_text, files::typed_texts, 1000;
    session_socket: peers::session_socket, peers::session_frames, 1000;
    http: peers::http, peers::http_requests, 1000;
    mqtt: peers::mqtt, peers::mqtt_packets, 1000;
}

/// Takes a result whose content does not matter: it was made without a panic.
pub fn seen<T>(result: T) {
    std::hint::black_box(result);
}

/// Pieces of a script: a control byte, a length of two bytes, and the bytes.
fn pieces(mut script: &[u8]) -> impl Iterator<Item = (u8, &[u8])> {
    std::iter::from_fn(move || {
        let (&[control, low, high], rest) = script.split_first_chunk()?;
        let (piece, rest) = rest.split_at(usize::from(u16::from_le_bytes([low, high])).min(rest.len()));
        script = rest;
        Some((control, piece))
    })
    .take(200)
}

/// The pause before a piece, by the low bits of its control byte.
fn pause(control: u8) -> Duration {
    const MILLISECONDS: [u64; 8] = [0, 1, 10, 50, 200, 1000, 6000, 60_000];
    Duration::from_millis(MILLISECONDS[usize::from(control % 8)])
}

/// The text of an input, if it has one.
fn text_of(data: &[u8]) -> Option<&str> {
    std::str::from_utf8(data).ok()
}
