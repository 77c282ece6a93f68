//! Control commands: reset, switches, messages, jobs (DX 3.3.19 to 3.3.24).

use super::robot::{Answer, command};
use super::world::{Mode, Refusal, World, code};
use crate::refuse_if;
use crate::yerc::payload::{CycleMode, Text};
use crate::yerc::table::Row;

/// Usable length of a message in bytes. The field has two more bytes.
const MESSAGE_LEN: usize = 30;
const MESSAGE_FIELD: usize = 32;
/// Size in bytes of a selection, which consists of a job name and a line.
const SELECTION: usize = 36;
const NAME_FIELD: usize = 32;
/// Instance that selects the job to execute. All other instances select master jobs.
const EXECUTE: u16 = 1;
const FIRST_MASTER: u16 = 10;

impl World {
    /// Executes a command that does not read or write data.
    pub(super) fn operate(&mut self, row: &Row, instance: u16, data: &[u8]) -> Answer {
        match row.number {
            command::RESET => self.reset(instance, data),
            command::SWITCH => self.switch(instance, data),
            command::CYCLE => self.set_cycle(data),
            command::MESSAGE => self.say(data),
            command::START => self.start_job(data),
            command::SELECT => self.select_job(instance, data),
            command::MOVE => self.move_cartesian(instance, data),
            command::MOVE_PULSE => self.move_pulse(instance, data),
            _ => Err(Refusal::Command),
        }?;
        Ok(Vec::new())
    }

    fn reset(&mut self, instance: u16, data: &[u8]) -> Result<(), Refusal> {
        execute_word(data)?;
        self.may_command()?;
        if instance == 1 {
            // An alarm that stops the whole controller stays active until a restart.
            refuse_if(self.alarms.major_is_active(), Refusal::Added(code::ALARM))?;
            self.alarms.clear();
        } else {
            self.switches.error = false;
        }
        Ok(())
    }

    fn switch(&mut self, instance: u16, data: &[u8]) -> Result<(), Refusal> {
        let on = match word(data)? {
            1 => true,
            2 => false,
            _ => return Err(Refusal::Added(code::RANGE)),
        };
        self.may_command()?;
        match (instance, on) {
            (1, on) => {
                self.switches.hold.command = on;
                if on {
                    self.stop();
                }
            }
            (2, true) => {
                self.may_power()?;
                self.switches.servo = true;
            }
            (2, false) => self.power_off(),
            (_, on) => self.switches.hlock = on,
        }
        Ok(())
    }

    fn set_cycle(&mut self, data: &[u8]) -> Result<(), Refusal> {
        let cycle = match word(data)? {
            1 => CycleMode::Step,
            2 => CycleMode::Once,
            3 => CycleMode::Continuous,
            _ => return Err(Refusal::Added(code::RANGE)),
        };
        refuse_if(self.switches.mode == Mode::Teach, Refusal::Added(code::MODE))?;
        self.may_command()?;
        self.switches.cycle = cycle;
        Ok(())
    }

    fn say(&mut self, data: &[u8]) -> Result<(), Refusal> {
        refuse_if(data.is_empty() || data.len() > MESSAGE_FIELD, Refusal::Added(code::REQUEST_SIZE))?;
        let text = Text::<MESSAGE_FIELD>::cut(data);
        refuse_if(text.as_bytes().len() > MESSAGE_LEN, Refusal::Added(code::RANGE))?;
        self.may_command()?;
        self.switches.message = text.as_bytes().to_vec();
        Ok(())
    }

    fn start_job(&mut self, data: &[u8]) -> Result<(), Refusal> {
        execute_word(data)?;
        self.may_move()?;
        refuse_if(!self.player.has_job(), Refusal::Added(code::NO_JOB_SET))?;
        self.player.start(self.now);
        Ok(())
    }

    fn select_job(&mut self, instance: u16, data: &[u8]) -> Result<(), Refusal> {
        refuse_if(data.len() != SELECTION, Refusal::Added(code::REQUEST_SIZE))?;
        let (name, line) = data.split_at(NAME_FIELD);
        let (name, line) = (Text::<NAME_FIELD>::cut(name), word(line)?);
        self.may_command()?;
        refuse_if(self.switches.editing, Refusal::Added(code::EDITING))?;
        refuse_if(self.is_running(), Refusal::Added(code::MOVING))?;
        let program = self.files.program(name.as_bytes()).ok_or(Refusal::Added(code::NO_SUCH_JOB))?;
        if instance == EXECUTE {
            let line = usize::try_from(line).unwrap_or(usize::MAX);
            refuse_if(!self.player.select(name.as_bytes(), program, line), Refusal::Added(code::RANGE))?;
        } else {
            self.player.masters.insert(instance - FIRST_MASTER, name.as_bytes().to_vec());
        }
        Ok(())
    }
}

/// Returns the data word of a request, which must have only one word.
pub(super) fn word(data: &[u8]) -> Result<u32, Refusal> {
    data.try_into().map(u32::from_le_bytes).map_err(|_| Refusal::Added(code::REQUEST_SIZE))
}

/// Checks the only word of a reset or start request, which must be 1.
fn execute_word(data: &[u8]) -> Result<(), Refusal> {
    if word(data)? == 1 { Ok(()) } else { Err(Refusal::Added(code::RANGE)) }
}
