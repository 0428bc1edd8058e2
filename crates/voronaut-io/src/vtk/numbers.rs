//! The types of numbers in arrays, and arrays as numbers.

use super::stored::{Layout, Stored};
use crate::bytes::Order;
use crate::words::shortened;
use voronaut::{Error, Result};

/// A type of numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Int8,
    UInt8,
    Int16,
    UInt16,
    Int32,
    UInt32,
    Int64,
    UInt64,
    Float32,
    Float64,
}

const KINDS: [(&str, Kind, u64); 10] = [
    ("Int8", Kind::Int8, 1),
    ("UInt8", Kind::UInt8, 1),
    ("Int16", Kind::Int16, 2),
    ("UInt16", Kind::UInt16, 2),
    ("Int32", Kind::Int32, 4),
    ("UInt32", Kind::UInt32, 4),
    ("Int64", Kind::Int64, 8),
    ("UInt64", Kind::UInt64, 8),
    ("Float32", Kind::Float32, 4),
    ("Float64", Kind::Float64, 8),
];

/// An array of a file, its numbers not yet looked at.
pub(super) struct Array {
    pub(super) name: String,
    pub(super) kind: Kind,
    /// Numbers per entry; `None` where the file does not say.
    pub(super) components: Option<u64>,
    /// Where its tag is.
    pub(super) tag: u64,
    /// Where its text or its bytes begin.
    pub(super) byte: u64,
    pub(super) stored: Stored,
}

impl Kind {
    /// The type of a name; `None` of those that are no numbers.
    pub(super) fn of_name(name: &str) -> Option<Self> {
        KINDS.iter().find(|(known, ..)| *known == name).map(|&(_, kind, _)| kind)
    }

    pub(super) fn is_whole(self) -> bool {
        !matches!(self, Self::Float32 | Self::Float64)
    }

    fn size(self) -> u64 {
        KINDS.iter().find(|(_, kind, _)| *kind == self).map_or(1, |&(.., size)| size)
    }
}

/// What all arrays of a file share.
#[derive(Clone, Copy)]
pub(super) struct Head<'a> {
    pub(super) place: &'a str,
    pub(super) layout: Layout,
}

impl Array {
    /// So many numbers of any type.
    ///
    /// # Errors
    /// [`Error::Parse`] where there are more or fewer, and of what is no number.
    pub(super) fn into_reals(self, count: u64, head: Head<'_>) -> Result<Vec<f64>> {
        if let Stored::Text(text) = &self.stored {
            return self.parse(text, count, head, "a number");
        }
        let (kind, bytes) = self.into_bytes(count, head)?;
        let order = head.layout.order;
        Ok(match kind {
            Kind::Int8 => each(&bytes, order, |b| f64::from(i8::from_le_bytes(b))),
            Kind::UInt8 => each(&bytes, order, |b| f64::from(u8::from_le_bytes(b))),
            Kind::Int16 => each(&bytes, order, |b| f64::from(i16::from_le_bytes(b))),
            Kind::UInt16 => each(&bytes, order, |b| f64::from(u16::from_le_bytes(b))),
            Kind::Int32 => each(&bytes, order, |b| f64::from(i32::from_le_bytes(b))),
            Kind::UInt32 => each(&bytes, order, |b| f64::from(u32::from_le_bytes(b))),
            Kind::Int64 => each(&bytes, order, |b| i64::from_le_bytes(b) as f64),
            Kind::UInt64 => each(&bytes, order, |b| u64::from_le_bytes(b) as f64),
            Kind::Float32 => each(&bytes, order, |b| f64::from(f32::from_le_bytes(b))),
            Kind::Float64 => each(&bytes, order, f64::from_le_bytes),
        })
    }

    /// So many whole numbers; those beyond the range of i64 come out as its largest.
    ///
    /// # Errors
    /// As of [`Array::into_reals`]; [`Error::Parse`] of an array of another type.
    pub(super) fn into_wholes(self, count: u64, head: Head<'_>) -> Result<Vec<i64>> {
        if !self.kind.is_whole() {
            return Err(self.error(head, "holds floating point numbers", "write whole numbers, such as Int64"));
        }
        if let Stored::Text(text) = &self.stored {
            return self.parse(text, count, head, "a whole number");
        }
        let (kind, bytes) = self.into_bytes(count, head)?;
        let order = head.layout.order;
        Ok(match kind {
            Kind::Int8 => each(&bytes, order, |b| i8::from_le_bytes(b).into()),
            Kind::UInt8 => each(&bytes, order, |b| u8::from_le_bytes(b).into()),
            Kind::Int16 => each(&bytes, order, |b| i16::from_le_bytes(b).into()),
            Kind::UInt16 => each(&bytes, order, |b| u16::from_le_bytes(b).into()),
            Kind::Int32 => each(&bytes, order, |b| i32::from_le_bytes(b).into()),
            Kind::UInt32 => each(&bytes, order, |b| u32::from_le_bytes(b).into()),
            Kind::UInt64 => each(&bytes, order, |b| i64::try_from(u64::from_le_bytes(b)).unwrap_or(i64::MAX)),
            Kind::Int64 | Kind::Float32 | Kind::Float64 => each(&bytes, order, i64::from_le_bytes),
        })
    }

    /// An [`Error::Parse`] at the beginning of the array: `what` follows its name.
    pub(super) fn error(&self, head: Head<'_>, what: &str, help: &str) -> Error {
        error(head, self.byte, &self.name, what, help)
    }

    fn into_bytes(self, count: u64, head: Head<'_>) -> Result<(Kind, Vec<u8>)> {
        let Self { name, kind, byte, stored, .. } = self;
        let bytes = stored.bytes(count.saturating_mul(kind.size())).map_err(|what| {
            error(
                head,
                byte,
                &name,
                &what,
                "check the counts of the piece and of the array, and that the file is whole",
            )
        })?;
        Ok((kind, bytes))
    }

    fn parse<T: std::str::FromStr>(&self, text: &str, count: u64, head: Head<'_>, what: &str) -> Result<Vec<T>> {
        const HELP: &str = "check the counts of the piece and of the array, and that the file is whole";
        let mut numbers = Vec::new();
        for word in text.split_ascii_whitespace() {
            if numbers.len() as u64 == count {
                return Err(self.error(head, &format!("holds more than {count} numbers"), HELP));
            }
            let entry = numbers.len() + 1;
            numbers.push(word.parse().map_err(|_| {
                let byte = self.byte + (word.as_ptr().addr() - text.as_ptr().addr()) as u64;
                let what = format!("holds '{}', which is not {what} (number {entry} of {count})", shortened(word));
                error(head, byte, &self.name, &what, "correct it, or check the type of the array")
            })?);
        }
        if (numbers.len() as u64) < count {
            let what = format!("holds {} numbers, where {count} are needed", numbers.len());
            return Err(self.error(head, &what, HELP));
        }
        Ok(numbers)
    }
}

/// An [`Error::Parse`] about an array.
pub(super) fn error(head: Head<'_>, byte: u64, array: &str, what: &str, help: &str) -> Error {
    Error::parse(format!("{}, byte {byte}", head.place), format!("array '{}' {what}", shortened(array)), help)
}

fn each<const N: usize, T>(bytes: &[u8], order: Order, from: impl Fn([u8; N]) -> T) -> Vec<T> {
    let (numbers, _) = bytes.as_chunks();
    let swapped = |mut number: [u8; N]| {
        number.reverse();
        from(number)
    };
    match order {
        Order::Little => numbers.iter().map(|&number| from(number)).collect(),
        Order::Big => numbers.iter().map(|&number| swapped(number)).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PLAIN: Layout = Layout { order: Order::Big, is_wide: false, is_compressed: false };

    fn array(kind: Kind, stored: Stored) -> Array {
        Array { name: "a".into(), kind, components: None, tag: 0, byte: 5, stored }
    }

    #[test]
    fn all_types_in_both_orders() {
        for (kind, little, value) in [
            (Kind::Int8, (-2_i8).to_le_bytes().to_vec(), -2),
            (Kind::UInt8, vec![200], 200),
            (Kind::Int16, (-300_i16).to_le_bytes().to_vec(), -300),
            (Kind::UInt16, 60_000_u16.to_le_bytes().to_vec(), 60_000),
            (Kind::Int32, (-70_000_i32).to_le_bytes().to_vec(), -70_000),
            (Kind::UInt32, u32::MAX.to_le_bytes().to_vec(), u32::MAX.into()),
            (Kind::Int64, (-(1_i64 << 40)).to_le_bytes().to_vec(), -(1 << 40)),
            (Kind::UInt64, (1_u64 << 40).to_le_bytes().to_vec(), 1 << 40),
            (Kind::Float32, 3_f32.to_le_bytes().to_vec(), 3),
            (Kind::Float64, 3_f64.to_le_bytes().to_vec(), 3),
        ] {
            let big = little.iter().rev().copied().collect();
            for (order, bytes) in [(Order::Little, little), (Order::Big, big)] {
                let head = Head { place: "f", layout: Layout { order, ..PLAIN } };
                let reals = array(kind, Stored::Plain(bytes.clone())).into_reals(1, head).unwrap();
                assert_eq!(reals[0].to_bits(), (value as f64).to_bits());
                let wholes = array(kind, Stored::Plain(bytes)).into_wholes(1, head);
                assert_eq!(wholes.ok(), kind.is_whole().then(|| vec![value]));
            }
        }
    }

    #[test]
    fn too_many_too_few_and_what_is_no_number() {
        let head = Head { place: "f", layout: PLAIN };
        let text = |text: &str| array(Kind::Int32, Stored::Text(text.into()));
        assert_eq!(text(" 1\n-2 ").into_wholes(2, head).unwrap(), [1, -2]);
        for (found, expected) in [
            (text("1 2 3").into_wholes(2, head), "f, byte 5: array 'a' holds more than 2 numbers"),
            (
                text("1").into_wholes(1 << 60, head),
                "f, byte 5: array 'a' holds 1 numbers, where 1152921504606846976 are needed",
            ),
            (
                text("1 2.5").into_wholes(2, head),
                "f, byte 7: array 'a' holds '2.5', which is not a whole number (number 2 of 2)",
            ),
            (
                array(Kind::UInt16, Stored::Plain(vec![0; 3])).into_wholes(2, head),
                "f, byte 5: array 'a' holds 3 bytes, where 4 are needed",
            ),
            (
                array(Kind::Float32, Stored::Plain(vec![])).into_wholes(0, head),
                "f, byte 5: array 'a' holds floating point numbers",
            ),
        ] {
            let error = found.unwrap_err();
            assert_eq!(error.to_string(), expected);
            assert!(!error.help().is_empty());
        }
    }
}
