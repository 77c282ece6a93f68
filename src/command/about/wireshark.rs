//! `armctl wireshark`: Wireshark dissectors of all protocols, written from the tables of the families.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::Context as _;

use crate::cli::VERSION;
use crate::command::families::FAMILIES;
use armctl_frame::prelude::*;
use armctl_frame::wireshark::PRELUDE;

/// Writes dissectors for Wireshark: armctl.lua decodes the protocols of all families, from the same tables as `armctl
/// decode`.
#[derive(Debug, Args)]
#[command(
    after_help = "Wireshark reads Lua files in its personal plugin folder when it starts (Help, About Wireshark, \
                  Folders):\n  Linux, macOS  ~/.local/lib/wireshark/plugins\n  Windows       \
                  %APPDATA%\\Wireshark\\plugins\n\nFilters: armctl_yerc.command == 0x72, armctl_toyo.command == \
                  \"STAS\", armctl_yrcx.command == 0x501, armctl_yrcx.alarm. Without installation: tshark -X \
                  lua_script:armctl.lua -r FILE."
)]
pub struct Wireshark {
    /// Folder for armctl.lua; it is created if it does not exist
    #[arg(value_name = "FOLDER")]
    folder: PathBuf,
}

/// Name of the file. It contains all families, because they share functions.
const FILE: &str = "armctl.lua";
/// First words of the file. A file without them was written by someone else.
const HEADER: &str = "-- Wireshark dissectors, written by armctl";

impl Wireshark {
    /// Writes the file.
    pub fn run(&self, run: &Run) -> Result<(), RunError> {
        let path = self.folder.join(FILE);
        let text = dissectors();
        write(&self.folder, &path, &text)?;
        let protocols = FAMILIES.map(|face| face.family().name());
        let report =
            WrittenDissectors { path: path.display().to_string(), bytes: text.len(), families: protocols.into() };
        run.local("wireshark", &report)
    }
}

/// Lua source of the dissectors of all families.
pub fn dissectors() -> String {
    let header =
        format!("{HEADER} {VERSION} (`armctl wireshark`). Do not edit: the next version overwrites this file.\n");
    let info = format!("if set_plugin_info then set_plugin_info({{ version = \"{VERSION}\" }}) end\n");
    [header, info, PRELUDE.to_owned()].into_iter().chain(FAMILIES.map(|face| face.dissector())).collect()
}

fn write(folder: &Path, path: &Path, text: &str) -> Result<(), Failure> {
    fs::create_dir_all(folder).with_context(|| folder.display().to_string())?;
    let name = || path.display().to_string();
    // A dissector of an older version is replaced, but not the file of another program.
    match fs::read(path) {
        Ok(old) if !old.starts_with(HEADER.as_bytes()) => {
            return Err(Failure::new(Kind::Rejected, format!("{} exists, and armctl did not write it", name()))
                .hint("name another folder, or move the file"));
        }
        _ => {}
    }
    Ok(fs::write(path, text).with_context(name)?)
}

/// The written file.
#[derive(Debug, Serialize, JsonSchema)]
pub struct WrittenDissectors {
    path: String,
    bytes: usize,
    /// Families whose protocols the file decodes.
    families: Vec<&'static str>,
}

impl Report for WrittenDissectors {
    fn view(&self) -> View {
        let Self { path, families, .. } = self;
        View::text(format!(
            "{path}: dissectors for {}\nWireshark reads the file at its start if the folder is a plugin folder (Help, \
             About Wireshark, Folders).\nWithout installation: tshark -X lua_script:{path} -r FILE.pcapng",
            families.join(", ")
        ))
    }
}
