//! `toyo program calls`.

use super::folder::{check_file, program_of, programs_in, read_program};
use crate::prelude::*;
use armctl_controller::names::Names;
use armctl_controller::references::Role;
use armctl_controller::toyo::program::{ControllerData, MAX_STEPS};
use armctl_frame::programs::Program;
use armctl_frame::programs::calls::CallReport;
use armctl_frame::programs::source::{ProgramSet, check_names};

/// Show which subroutines a program calls, and which tasks it starts: the call tree and recursion.
#[derive(Debug, Args)]
#[command(
    after_help = "A subroutine is a tag that CAL, CALC, CALI or CALT calls. Its steps end at the next subroutine. Its \
                  name is the program and the label of the tag, for example program-1/weld. TSTR starts the program of \
                  another task.\n\nWithout --from, armctl reads the program of the current task."
)]
pub struct Calls {
    /// Show only the tree below this program or subroutine
    name: Option<String>,
    /// Read the programs in this folder, without a robot: a backup, or files program-N.txt and *.toyo
    #[arg(long, value_name = "FOLDER", add = ValueKind::Backup)]
    from: Option<PathBuf>,
}

impl Command for Calls {
    type Family = Toyo;
    type Report = CallReport;
    const ID: &'static str = "toyo.program.calls";

    fn takes_robot(&self) -> bool {
        self.from.is_none()
    }

    fn run_alone(&self) -> Result<CallReport> {
        let folder = self.from.as_deref().ok_or_else(|| Failure::local("internal error: no folder to read"))?;
        self.tree(programs_in(folder)?)
    }

    async fn run(&self, context: Context<'_, Toyo>) -> Result<CallReport> {
        self.tree(program_of(context.link, context.screen, None).await?)
    }
}

impl Calls {
    fn tree(&self, set: ProgramSet) -> Result<CallReport> {
        let mut programs = Vec::new();
        for file in &set.files {
            let checked = check_file(file, MAX_STEPS, &Names::default(), &ControllerData::default());
            // An invalid program has no calls that can be shown.
            crate::program::text::valid(&file.file, &checked)?;
            programs.extend(split(read_program(file, &checked)));
        }
        let names = programs.iter().map(|program| program.name.as_str());
        check_names(self.name.as_slice(), names.clone())?;
        // The program of each task can be started from outside.
        let masters: Vec<&str> = names.filter(|name| !name.contains('/')).collect();
        Ok(CallReport::new(&programs, self.name.as_deref(), &masters, set.unread))
    }
}

/// Splits a program at its subroutines.
fn split(mut program: Program) -> Vec<Program> {
    let calls = program.references().filter(|(_, reference)| reference.role == Role::Call);
    let called: BTreeSet<String> = calls.map(|(_, reference)| reference.name.clone()).collect();
    let (whole, file) = (program.name.clone(), program.file.clone());
    let mut parts = vec![Program { name: whole.clone(), file: file.clone(), ..Program::default() }];
    for mut line in program.lines.drain(..) {
        let mut labels = line.references.iter().filter(|reference| reference.role == Role::Label);
        if let Some(label) = labels.find(|label| called.contains(&label.name)) {
            let name = format!("{whole}/{}", label.name);
            parts.push(Program { name, file: file.clone(), ..Program::default() });
        }
        for reference in line.references.iter_mut().filter(|reference| reference.role == Role::Call) {
            reference.name = format!("{whole}/{}", reference.name);
        }
        if let Some(part) = parts.last_mut() {
            part.lines.push(line);
        }
    }
    parts
}
