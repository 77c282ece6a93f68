//! Plans the smallest number of requests for many variables, registers or I/O groups.
//!
//! A read may include elements that were not requested but lie between requested elements: additional bytes of a
//! datagram cost less than another round trip. Reads of positions contain no such elements, because the controller
//! refuses the whole answer if one position is undefined. A write never includes elements that were not requested.

use std::collections::{BTreeMap, BTreeSet};
use std::hash::Hash;

use super::reference::{Reference, VariableKind};
use super::value::Value;
use crate::yerc::Model;
use crate::yerc::payload::PayloadError;
use crate::yerc::query::{
    Query, QueryError, ReadIo, ReadIoGroups, ReadRegister, ReadRegisters, ReadVariable, ReadVariables, WriteIo,
    WriteIoGroups, WriteQuery, WriteRegister, WriteRegisters, WriteVariable, WriteVariables,
};
use crate::yerc::request::Request;
use crate::yerc::table::{Plural, Row};

/// A range of consecutive numbers that begins at `first`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Block {
    first: u16,
    count: u16,
}

/// A query for one element, or a plural query.
#[derive(Debug, Clone, PartialEq)]
enum Either<S, P> {
    Single(S),
    Plural(P),
}

impl<S: Query<Answer = A>, P: Query<Answer = Vec<A>>, A> Either<S, P> {
    /// Decodes the elements of the answer.
    fn decode_all(&self, data: &[u8]) -> Result<Vec<A>, PayloadError> {
        match self {
            Self::Single(query) => query.decode(data).map(|element| vec![element]),
            Self::Plural(query) => query.decode(data),
        }
    }
}

impl<S: Query, P: Query> Either<S, P> {
    fn request(&self) -> Request {
        match self {
            Self::Single(query) => query.request(),
            Self::Plural(query) => query.request(),
        }
    }
}

/// A read request of a plan.
pub trait PlannedRead: Query<Answer = Vec<(<Self as PlannedRead>::Item, <Self as PlannedRead>::Value)>> {
    /// Identifier of an element.
    type Item: Copy + Eq + Hash;
    /// Value of an element.
    type Value;

    /// The requested elements, in ascending order.
    fn wanted(&self) -> &[Self::Item];
}

macro_rules! read_step {
    ($(#[$doc:meta])* $name:ident, $item:ty, $value:ty, $single:ty, $plural:ty, $number:expr) => {
        $(#[$doc])*
        #[derive(Debug, Clone, PartialEq)]
        pub struct $name {
            query: Either<$single, $plural>,
            first: u16,
            wanted: Vec<$item>,
        }

        impl PlannedRead for $name {
            type Item = $item;
            type Value = $value;

            fn wanted(&self) -> &[$item] {
                &self.wanted
            }
        }

        impl Query for $name {
            type Answer = Vec<($item, $value)>;

            fn request(&self) -> Request {
                self.query.request()
            }

            fn decode(&self, data: &[u8]) -> Result<Self::Answer, PayloadError> {
                let elements = self.query.decode_all(data)?;
                let number: fn(&$item) -> u16 = $number;
                let value = |item: &$item| {
                    let element = elements.get(usize::from(number(item) - self.first));
                    element.cloned().expect("blocks contain the requested elements")
                };
                Ok(self.wanted.iter().map(|item| (*item, value(item))).collect())
            }
        }
    };
}

read_step! {
    /// A read request for variables.
    ReadStep, Reference, Value, ReadVariable, ReadVariables, |reference| reference.number
}
read_step! {
    /// A read request for registers.
    RegisterStep, u16, u16, ReadRegister, ReadRegisters, |number| *number
}
read_step! {
    /// A read request for I/O groups.
    IoStep, u16, u8, ReadIo, ReadIoGroups, |number| *number
}

macro_rules! write_step {
    ($(#[$doc:meta])* $name:ident, $item:ty, $single:ty, $plural:ty) => {
        $(#[$doc])*
        #[derive(Debug, Clone, PartialEq)]
        pub struct $name {
            query: Either<$single, $plural>,
            written: Vec<$item>,
        }

        impl $name {
            /// The written elements, in ascending order.
            pub fn written(&self) -> &[$item] {
                &self.written
            }
        }

        impl WriteQuery for $name {
            fn write_request(&self) -> Request {
                self.query.request()
            }
        }
    };
}

write_step! {
    /// A write request for variables.
    WriteStep, Reference, WriteVariable, WriteVariables
}
write_step! {
    /// A write request for registers.
    WriteRegisterStep, u16, WriteRegister, WriteRegisters
}
write_step! {
    /// A write request for I/O groups.
    WriteIoStep, u16, WriteIo, WriteIoGroups
}

/// Plans the reads of these variables. The variables can be in any order; duplicates are read once.
#[expect(clippy::missing_panics_doc, reason = "the planner keeps to the limits of the table")]
pub fn plan_reads(references: &[Reference]) -> Vec<ReadStep> {
    let mut steps = Vec::new();
    for kind in VariableKind::all() {
        let numbers: BTreeSet<u16> =
            references.iter().filter(|reference| reference.kind == kind).map(|reference| reference.number).collect();
        let range = |number| if number <= kind.last_standard() { (0, kind.last_standard()) } else { (0, number) };
        for (block, wanted) in read_blocks(&numbers, kind.plural(), !kind.is_position(), range) {
            let query = match block.count {
                1 => Either::Single(ReadVariable::new(kind, block.first)),
                count => Either::Plural(
                    ReadVariables::new(kind, block.first, count).expect("blocks keep to the limits of the table"),
                ),
            };
            let wanted = wanted.into_iter().map(|number| Reference::new(kind, number)).collect();
            steps.push(ReadStep { query, first: block.first, wanted });
        }
    }
    steps
}

/// Plans the reads of these registers.
pub fn plan_register_reads(model: Model, numbers: &[u16]) -> Result<Vec<RegisterStep>, QueryError> {
    // Numbers that do not exist are not sorted out here: the constructor of the query refuses them.
    let numbers: BTreeSet<u16> = numbers.iter().copied().collect();
    read_blocks(&numbers, limits(0x301), true, |number| run_of(0x301, model, number))
        .into_iter()
        .map(|(block, wanted)| {
            let query = match block.count {
                1 => Either::Single(ReadRegister::new(model, block.first)?),
                count => Either::Plural(ReadRegisters::new(model, block.first, count)?),
            };
            Ok(RegisterStep { query, first: block.first, wanted })
        })
        .collect()
}

/// Plans the reads of these I/O groups.
pub fn plan_io_reads(model: Model, groups: &[u16]) -> Result<Vec<IoStep>, QueryError> {
    let groups: BTreeSet<u16> = groups.iter().copied().collect();
    read_blocks(&groups, limits(0x300), true, |group| run_of(0x300, model, group))
        .into_iter()
        .map(|(block, wanted)| {
            let query = match block.count {
                1 => Either::Single(ReadIo::new(model, block.first)?),
                count => Either::Plural(ReadIoGroups::new(model, block.first, count)?),
            };
            Ok(IoStep { query, first: block.first, wanted })
        })
        .collect()
}

/// Plans the writes of these values. If a variable occurs twice, the last value counts.
pub fn plan_writes(values: &[(u16, Value)]) -> Result<Vec<WriteStep>, QueryError> {
    let mut steps = Vec::new();
    for kind in VariableKind::all() {
        let values: BTreeMap<u16, &Value> =
            values.iter().filter(|(_, value)| value.kind() == kind).map(|(number, value)| (*number, value)).collect();
        let numbers = values.keys().copied().collect();
        for Block { first, count } in write_blocks(&numbers, kind.plural()) {
            let block: Vec<Value> =
                values.range(first..).take(count.into()).map(|(_, value)| (*value).clone()).collect();
            let written = (first..=u16::MAX).take(count.into()).map(|number| Reference::new(kind, number)).collect();
            let query = match <[Value; 1]>::try_from(block) {
                Ok([value]) => Either::Single(WriteVariable::new(first, value)?),
                Err(block) => Either::Plural(WriteVariables::new(first, block)?),
            };
            steps.push(WriteStep { query, written });
        }
    }
    Ok(steps)
}

/// Plans the writes of these registers.
pub fn plan_register_writes(model: Model, values: &[(u16, u16)]) -> Result<Vec<WriteRegisterStep>, QueryError> {
    write_signals(values, limits(0x301))
        .into_iter()
        .map(|(first, block)| {
            let written = numbered(first, block.len());
            let query = match block.as_slice() {
                [value] => Either::Single(WriteRegister::new(model, first, *value)?),
                _ => Either::Plural(WriteRegisters::new(model, first, block)?),
            };
            Ok(WriteRegisterStep { query, written })
        })
        .collect()
}

/// Plans the writes of these I/O groups.
pub fn plan_io_writes(model: Model, values: &[(u16, u8)]) -> Result<Vec<WriteIoStep>, QueryError> {
    write_signals(values, limits(0x300))
        .into_iter()
        .map(|(first, block)| {
            let written = numbered(first, block.len());
            let query = match block.as_slice() {
                [value] => Either::Single(WriteIo::new(model, first, *value)?),
                _ => Either::Plural(WriteIoGroups::new(model, first, block)?),
            };
            Ok(WriteIoStep { query, written })
        })
        .collect()
}

/// Forms blocks over sorted numbers. Each block has its requested numbers. `range` returns the first and last existing
/// element around a number: a block must not go beyond them, and a neighbor within them can make a count even.
fn read_blocks(
    numbers: &BTreeSet<u16>,
    Plural { max, even }: Plural,
    bridge: bool,
    range: impl Fn(u16) -> (u16, u16),
) -> Vec<(Block, Vec<u16>)> {
    let mut blocks = Vec::new();
    let mut numbers = numbers.iter().copied().peekable();
    while let Some(first) = numbers.next() {
        let mut wanted = vec![first];
        let mut last = first;
        while let Some(next) = numbers.next_if(|&next| {
            let near = bridge || next - last == 1;
            near && next - first < max && range(next).0 <= first
        }) {
            wanted.push(next);
            last = next;
        }
        let count = last - first + 1;
        let (lowest, highest) = range(last);
        let block = match count {
            count if !even || count == 1 || count % 2 == 0 => Block { first, count },
            count if last < highest => Block { first, count: count + 1 },
            count if first > lowest => Block { first: first - 1, count: count + 1 },
            // No neighbor can make the count even. The last number gets a single read, and the block ends before this
            // number.
            _ => {
                let alone = wanted.pop().into_iter().collect();
                blocks.push((Block { first: last, count: 1 }, alone));
                match wanted.last().map_or(1, |last| last - first + 1) {
                    1 => Block { first, count: 1 },
                    count => Block { first, count: count.next_multiple_of(2) },
                }
            }
        };
        blocks.push((block, wanted));
    }
    blocks
}

/// Forms blocks of consecutive numbers. If counts must be even, the last element of an odd block gets a single write.
fn write_blocks(numbers: &BTreeSet<u16>, Plural { max, even }: Plural) -> Vec<Block> {
    let mut blocks: Vec<Block> = Vec::new();
    for &number in numbers {
        match blocks.last_mut() {
            Some(block) if block.count < max && block.first + block.count == number => block.count += 1,
            _ => blocks.push(Block { first: number, count: 1 }),
        }
    }
    blocks
        .into_iter()
        .flat_map(|Block { first, count }| {
            let alone = u16::from(even && count > 1 && count % 2 == 1);
            let rest = Block { first, count: count - alone };
            [Some(rest), (alone == 1).then(|| Block { first: first + count - 1, count: 1 })]
        })
        .flatten()
        .collect()
}

fn write_signals<T: Copy>(values: &[(u16, T)], plural: Plural) -> Vec<(u16, Vec<T>)> {
    let values: BTreeMap<u16, T> = values.iter().copied().collect();
    write_blocks(&values.keys().copied().collect(), plural)
        .into_iter()
        .map(|Block { first, count }| {
            (first, values.range(first..).take(count.into()).map(|(_, value)| *value).collect())
        })
        .collect()
}

fn numbered(first: u16, count: usize) -> Vec<u16> {
    (first..=u16::MAX).take(count).collect()
}

fn limits(command: u16) -> Plural {
    Row::from_number(command).and_then(|row| row.plural).expect("registers and I/O groups have a plural command")
}

/// First and last of the contiguous instances around `number`. Both are `number` itself if this instance does not
/// exist.
fn run_of(command: u16, model: Model, number: u16) -> (u16, u16) {
    let spans = Row::from_number(command).map_or(&[][..], |row| row.instances.for_model(model));
    let Some(at) = spans.iter().position(|span| span.contains(number)) else { return (number, number) };
    let joined = |lower: usize| spans[lower].last.checked_add(1) == Some(spans[lower + 1].first);
    let first = (0..at).rev().take_while(|&lower| joined(lower)).last().unwrap_or(at);
    let last = (at..spans.len() - 1).take_while(|&lower| joined(lower)).last().map_or(at, |lower| lower + 1);
    (spans[first].first, spans[last].last)
}

#[cfg(test)]
mod tests {
    use super::super::parse_references;
    use super::*;

    fn references(texts: &[&str]) -> Vec<Reference> {
        texts.iter().flat_map(|text| parse_references(text).unwrap()).collect()
    }

    /// Command, instance and count of each request.
    fn shape(requests: impl IntoIterator<Item = Request>) -> Vec<(u16, u16, u32)> {
        requests
            .into_iter()
            .map(|request| {
                let count = request.data.first_chunk().map_or(1, |count| u32::from_le_bytes(*count));
                (request.command, request.instance, if request.command >= 0x300 { count } else { 1 })
            })
            .collect()
    }

    #[test]
    fn three_kinds_are_three_requests() {
        let steps = plan_reads(&references(&["B0..B99", "I0..I99", "D0..D99"]));
        let shape = shape(steps.iter().map(Query::request));
        assert_eq!(shape, [(0x302, 0, 100), (0x303, 0, 100), (0x304, 0, 100)]);
    }

    #[test]
    fn odd_number_of_bytes_includes_a_neighbour() {
        let shape = |texts: &[&str]| shape(plan_reads(&references(texts)).iter().map(Query::request));
        assert_eq!(shape(&["B0..B2"]), [(0x302, 0, 4)]);
        assert_eq!(shape(&["B97..B99"]), [(0x302, 96, 4)]);
        assert_eq!(shape(&["B5"]), [(0x7A, 5, 1)]);
        assert_eq!(shape(&["B0", "B50"]), [(0x302, 0, 52)]);
        assert_eq!(shape(&["B98..B100"]), [(0x302, 97, 4)]);
        assert_eq!(shape(&["B0..B100"]), [(0x7A, 100, 1), (0x302, 0, 100)]);
        assert_eq!(shape(&["B0", "B300"]), [(0x7A, 300, 1), (0x7A, 0, 1)]);
        assert_eq!(shape(&["B0", "B2", "B300"]), [(0x7A, 300, 1), (0x302, 0, 4)]);
        assert_eq!(shape(&["P0..P9", "P12"]), [(0x307, 0, 9), (0x7F, 9, 1), (0x7F, 12, 1)]);
        assert_eq!(shape(&["S0..S14"]), [(0x30C, 0, 14), (0x8C, 14, 1)]);
    }

    #[test]
    fn assigns_answers_to_references() {
        let step = &plan_reads(&references(&["B3", "B5", "B3"]))[0];
        assert_eq!(step.request().data, [4, 0, 0, 0]);
        let answer = step.decode(&[4, 0, 0, 0, 30, 40, 50, 60]).unwrap();
        let b = |number| Reference::new(VariableKind::B, number);
        assert_eq!(answer, [(b(3), Value::Byte(30)), (b(5), Value::Byte(50))]);
        assert!(matches!(step.decode(&[3, 0, 0, 0, 1, 2, 3]), Err(PayloadError::Count { asked: 4, .. })));
        assert!(matches!(step.decode(&[4, 0, 0, 0, 1]), Err(PayloadError::Short { .. })));
    }

    #[test]
    fn writes_only_named_items() {
        let values = |numbers: &[u16]| numbers.iter().map(|&n| (n, Value::Byte(1))).collect::<Vec<_>>();
        let shape = |numbers: &[u16]| shape(plan_writes(&values(numbers)).unwrap().iter().map(Query::request));
        assert_eq!(shape(&[0, 1, 2]), [(0x302, 0, 2), (0x7A, 2, 1)]);
        assert_eq!(shape(&[0, 2]), [(0x7A, 0, 1), (0x7A, 2, 1)]);
        assert_eq!(shape(&[7, 6, 5, 4]), [(0x302, 4, 4)]);
    }

    #[test]
    fn signal_plans_stay_within_their_class() {
        let io = |groups: &[u16]| shape(plan_io_reads(Model::Fs100, groups).unwrap().iter().map(Query::request));
        assert_eq!(io(&[1, 128]), [(0x300, 1, 128)]);
        assert_eq!(io(&[126, 128]), [(0x300, 125, 4)]);
        assert_eq!(io(&[128, 1001]), [(0x78, 128, 1), (0x78, 1001, 1)]);
        assert!(plan_io_reads(Model::Fs100, &[129]).is_err());
        assert!(plan_io_writes(Model::Fs100, &[(1, 1)]).is_err());
        let registers = plan_register_reads(Model::Fs100, &[0, 559, 560, 999]).unwrap();
        assert_eq!(shape(registers.iter().map(Query::request)), [(0x79, 0, 1), (0x301, 559, 2), (0x79, 999, 1)]);
        let writes = plan_register_writes(Model::Dx200, &[(1, 1), (2, 2), (5, 5)]).unwrap();
        assert_eq!(shape(writes.iter().map(Query::request)), [(0x301, 1, 2), (0x79, 5, 1)]);
    }
}
