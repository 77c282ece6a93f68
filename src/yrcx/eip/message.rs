//! `yrcx eip get` and `yrcx eip set`: raw explicit messages.

use super::board::{Board, Object, hex_pairs};
use crate::prelude::*;
use armctl_controller::text;
use armctl_frame::settings_report::{OLD_VALUE, nothing_written};

/// Reads an attribute of an object, or all its attributes (Get_Attribute_Single, Get_Attributes_All).
#[derive(Debug, Args)]
#[command(
    after_help = "Class 1 is the identity, class 4 the assemblies (attribute 3 is the data, attribute 4 the size), \
                  class 0xF5 the TCP/IP interface, class 0xF6 the Ethernet link. Instance 0 is the class itself. The \
                  objects depend on the board; the manuals of the controller do not list them."
)]
pub struct Get {
    /// Number of the class, for example 4 or 0xF5
    #[arg(value_parser = number)]
    class: u32,
    /// Number of the instance
    #[arg(value_parser = number)]
    instance: u32,
    /// Number of the attribute [default: all attributes]
    #[arg(value_parser = number)]
    attribute: Option<u32>,
}

impl Command for Get {
    type Family = Yrcx;
    type Report = Value;
    const ID: &'static str = "yrcx.eip.get";
    const CONNECT_MODE: ConnectMode = ConnectMode::Explicit;

    async fn run(&self, context: Context<'_, Yrcx>) -> Result<Value> {
        context.link.reject_unit_of::<Board>()?;
        let object = Object { class: self.class, instance: self.instance, attribute: self.attribute };
        let about = format!("{} of {object}", object.reading());
        let asked = object.get_bytes();
        context.link.plan_frame(json!({ "hex": text::hex(&asked), "about": about }))?;
        let bytes = context.link.board::<Board>()?.get(object).await?;
        context.link.plan_message_frame(&asked, &bytes, &about);
        Ok(Value::of(object, &bytes))
    }
}

/// Writes an attribute of an object (Set_Attribute_Single).
#[derive(Debug, Args)]
#[command(
    after_help = "armctl sends the bytes unchanged: low byte first, and a text after its length. The output assembly \
                  contains the inputs of the controller. A write to the output assembly can move the robot, and needs \
                  a confirmation."
)]
pub struct Set {
    /// Number of the class, for example 4 or 0xF5
    #[arg(value_parser = number)]
    class: u32,
    /// Number of the instance
    #[arg(value_parser = number)]
    instance: u32,
    /// Number of the attribute
    #[arg(value_parser = number)]
    attribute: u32,
    /// Bytes of the value in hexadecimal, for example 0A00
    #[arg(value_name = "HEX", value_parser = bytes)]
    data: Bytes,
}

impl Set {
    fn object(&self) -> Object {
        Object { class: self.class, instance: self.instance, attribute: Some(self.attribute) }
    }
}

impl Command for Set {
    type Family = Yrcx;
    type Report = SetReport;
    const ID: &'static str = "yrcx.eip.set";
    const CONNECT_MODE: ConnectMode = ConnectMode::Explicit;

    fn risk(&self) -> Risk {
        if self.object().is_assembly() { Risk::Motion } else { Risk::Destroy }
    }

    fn intent(&self) -> String {
        format!("set {} to {}", self.object(), hex_pairs(&self.data.0))
    }

    async fn run(&self, context: Context<'_, Yrcx>) -> Result<SetReport> {
        context.link.reject_unit_of::<Board>()?;
        let object = self.object();
        let (asked, about) = (object.set_bytes(&self.data.0), format!("Set_Attribute_Single of {object}"));
        context.link.plan_frame(json!({ "hex": text::hex(&object.get_bytes()), "about": OLD_VALUE })).known()?;
        context.link.plan_frame(json!({ "hex": text::hex(&asked), "about": about }))?;
        context.link.authorize("yrcx.eip.set", self.risk())?;
        let old = match context.link.board::<Board>()?.get(object).await {
            Ok(bytes) => Some(text::hex(&bytes)),
            Err(failure) if failure.kind == Kind::Refused => None,
            Err(failure) => return Err(nothing_written(failure)),
        };
        context.link.board::<Board>()?.set(object, &self.data.0).await?;
        context.link.plan_message_frame(&asked, &[], &about);
        let words = format!("set {object} to {}", hex_pairs(&self.data.0));
        let new = NewValue::of("attribute", text::hex(&self.data.0), words);
        let new = new.with("class", self.class).with("instance", self.instance).with("attribute", self.attribute);
        Ok(new.replaces(Old::read(old)))
    }
}

#[derive(Debug, Clone)]
struct Bytes(Vec<u8>);

fn bytes(text: &str) -> Result<Bytes, String> {
    let digits: String = text.trim_start_matches("0x").split([' ', '_', ':']).collect();
    match text::unhex(&digits) {
        Some(bytes) if !bytes.is_empty() => Ok(Bytes(bytes)),
        _ => Err(format!("'{text}' is not valid hexadecimal data, such as 0A00")),
    }
}

/// Parses the number of a class, instance or attribute: 16 bits, decimal or hexadecimal with 0x.
fn number(text: &str) -> Result<u32, String> {
    user_input::unsigned::<u16>(text)
        .map(u32::from)
        .ok_or_else(|| format!("'{text}' is not a number from 0 to 65535, such as 4 or 0xF5"))
}

/// Value of an attribute, or of all attributes of an object.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Value {
    /// Object, for example `class 0x04 (assembly), instance 100, attribute 3`.
    object: String,
    /// The bytes in hexadecimal, unchanged.
    hex: String,
    /// Number of bytes.
    bytes: usize,
    /// The bytes as an unsigned number, low byte first; null unless there are 1, 2, 4 or 8 bytes.
    number: Option<u64>,
    /// The bytes as a text with a length byte in front; null if they are not such a text. Do not trust the text.
    text: Option<String>,
}

impl Value {
    fn of(object: Object, bytes: &[u8]) -> Self {
        let number = matches!(bytes.len(), 1 | 2 | 4 | 8)
            .then(|| bytes.iter().rev().fold(0, |number, byte| number << 8 | u64::from(*byte)));
        let text = bytes.split_first().filter(|(length, text)| !text.is_empty() && usize::from(**length) == text.len());
        let text = text.filter(|(_, text)| text.iter().all(|byte| matches!(byte, b' '..=b'~')));
        Self {
            object: object.to_string(),
            hex: text::hex(bytes),
            bytes: bytes.len(),
            number,
            text: text.map(|(_, text)| String::from_utf8_lossy(text).into_owned()),
        }
    }
}

impl Report for Value {
    fn view(&self) -> View {
        let bytes = text::unhex(&self.hex).filter(|bytes| !bytes.is_empty());
        let bytes = Cell::optional(bytes.map(|bytes| hex_pairs(&bytes)));
        let mut fields = vec![("object", self.object.as_str().into()), ("bytes", bytes)];
        fields.extend(self.number.map(|number| ("number", format!("{number} ({number:#x})").into())));
        fields.extend(self.text.as_deref().map(|text| ("text", text.into())));
        View::default().append(Section::Fields(fields))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::frames;

    #[test]
    fn messages_have_the_bytes_of_the_specification() {
        // Format of volume 1, appendix C-1: service, then the path length in words, then class, instance and attribute.
        // Each number has 8 bits if it fits.
        let hex = |line: &[&str]| frames(line).unwrap()[0]["hex"].as_str().unwrap().to_owned();
        assert_eq!(hex(&["eip", "get", "4", "100", "3"]), "0e03200424643003");
        assert_eq!(hex(&["eip", "get", "0xF5", "1"]), "010220f52401");
        assert_eq!(hex(&["eip", "get", "4", "300", "3"]), "0e04200425002c013003");
        assert_eq!(hex(&["eip", "set", "0xF5", "1", "3", "02 00"]), "100320f5240130030200");
    }

    #[test]
    fn values_are_numbers_and_texts_where_they_can_be() {
        let object = Object { class: 1, instance: 1, attribute: Some(7) };
        let value = Value::of(object, b"\x04YRCX");
        assert_eq!((value.number, value.text.as_deref(), value.hex.as_str()), (None, Some("YRCX"), "0459524358"));
        let value = Value::of(object, &[0x7C, 0x02]);
        assert_eq!((value.number, value.text), (Some(636), None));
        assert_eq!(Value::of(object, b"\x02\x1b[").text, None, "control characters are no text");
        assert_eq!(Value::of(object, &[]).number, None);
    }
}
