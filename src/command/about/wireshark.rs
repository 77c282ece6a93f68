//! `armctl wireshark`: Wireshark dissectors of all protocols, written from the tables of the families.

use std::fs;

use crate::command::families::FAMILIES;
use armctl_frame::prelude::*;
use armctl_frame::wireshark::PRELUDE;

/// Writes dissectors for Wireshark: armctl.lua shows what `armctl decode` shows. A file of an older version is replaced.
#[derive(Debug, Args)]
#[command(after_help = INSTALL)]
pub struct Wireshark {
    /// Folder for armctl.lua; it is created if it does not exist
    #[arg(value_name = "FOLDER")]
    folder: PathBuf,
}

/// Name of the file. It contains all families, because they share functions.
const FILE: &str = "armctl.lua";

/// How to use the file.
const INSTALL: &str = "Wireshark reads Lua files at its start from its plugin folder (Help, About Wireshark, Folders):\n  \
                       Linux, macOS  ~/.local/lib/wireshark/plugins\n  Windows       %APPDATA%\\Wireshark\\plugins\n\n\
                       From any other folder: tshark -X lua_script:FOLDER/armctl.lua -r FILE.pcapng\nFilters: \
                       armctl_yerc.command == 0x72, armctl_toyo.command == \"STAS\", armctl_yrcx.command == 0x501";

impl Wireshark {
    /// Writes the file.
    pub fn run(&self, run: &Run) -> Result<(), RunError> {
        let (path, text) = (self.folder.join(FILE), dissectors());
        fs::create_dir_all(&self.folder).with_context(|| self.folder.display().to_string())?;
        fs::write(&path, &text).with_context(|| path.display().to_string())?;
        let families = FAMILIES.map(|face| face.family.name()).into();
        run.local("wireshark", &WrittenDissectors { path: path.display().to_string(), bytes: text.len(), families })
    }
}

/// Lua source of the dissectors of all families.
fn dissectors() -> String {
    const HEAD: &str =
        concat!("-- Written by armctl ", env!("CARGO_PKG_VERSION"), " from its tables: `armctl wireshark`.\n");

    [HEAD.to_owned(), PRELUDE.to_owned()].into_iter().chain(FAMILIES.map(|face| (face.dissector)())).collect()
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
        View::text(format!("{}: dissectors for {}\n\n{INSTALL}", self.path, self.families.join(", ")))
    }
}
