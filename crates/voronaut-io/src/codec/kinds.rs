//! What numbers are made of in files: text or bytes, of which order and how many.

use std::fmt;
use std::path::Path;

/// How a file is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// Words on lines: `.mesh`, `.sol`.
    Text,
    /// Bytes, little endian, with doubles. `.meshb`, `.solb`: libMeshb's, version 2 (3 where a file may have more than 1 GB).
    Binary,
}

impl Form {
    /// That of a solution's file: binary if its name ends in `.solb`.
    pub(crate) fn of_solution(path: &Path) -> Self {
        let is_binary = path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("solb"));
        if is_binary { Form::Binary } else { Form::Text }
    }
}

/// Which byte of a number comes first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Order {
    /// The least.
    Little,
    /// The greatest.
    Big,
}

/// A type of numbers in binary files, and how many bytes it has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    Signed(usize),
    Unsigned(usize),
    Float(usize),
}

impl Order {
    /// The bits of a number of one to eight bytes.
    pub(crate) fn bits(self, bytes: &[u8]) -> u64 {
        let bits = match *bytes {
            [a, b, c, d] => u32::from_le_bytes([a, b, c, d]).into(),
            [a, b, c, d, e, f, g, h] => u64::from_le_bytes([a, b, c, d, e, f, g, h]),
            _ => bytes.iter().rev().fold(0, |bits, &byte| bits << 8 | u64::from(byte)),
        };
        if self == Order::Big { bits.swap_bytes() >> (64 - 8 * bytes.len()) } else { bits }
    }
}

impl Kind {
    /// Every type that a format has.
    pub(crate) fn all() -> impl Iterator<Item = Self> {
        let wholes = [1, 2, 4, 8].into_iter().flat_map(|size| [Self::Signed(size), Self::Unsigned(size)]);
        wholes.chain([Self::Float(4), Self::Float(8)])
    }

    /// The type of a name such as `Int32`; `None` of those that are no numbers.
    pub(crate) fn of_name(name: &str) -> Option<Self> {
        Self::all().find(|kind| kind.to_string() == name)
    }

    /// In bytes.
    pub(crate) fn size(self) -> usize {
        let (Self::Signed(size) | Self::Unsigned(size) | Self::Float(size)) = self;
        size
    }

    pub(crate) fn is_whole(self) -> bool {
        !matches!(self, Self::Float(_))
    }

    /// The whole number of some bits; those beyond the range of i64 come out as its largest.
    pub(crate) fn whole(self, bits: u64) -> i64 {
        let unused = 64 - 8 * self.size();
        match self {
            Self::Unsigned(_) => i64::try_from(bits).unwrap_or(i64::MAX),
            _ => (bits << unused).cast_signed() >> unused,
        }
    }

    /// The number of some bits.
    pub(crate) fn real(self, bits: u64) -> f64 {
        match self {
            Self::Float(4) => f32::from_bits(bits as u32).into(),
            Self::Float(_) => f64::from_bits(bits),
            Self::Unsigned(_) => bits as f64,
            Self::Signed(_) => self.whole(bits) as f64,
        }
    }
}

/// As VTK calls it.
impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = match self {
            Self::Signed(_) => "Int",
            Self::Unsigned(_) => "UInt",
            Self::Float(_) => "Float",
        };
        write!(f, "{name}{}", 8 * self.size())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_all_kinds_in_both_orders() {
        for (kind, little, value) in [
            (Kind::Signed(1), [0xfe].as_slice(), -2.0),
            (Kind::Unsigned(1), &[0xfe], 254.0),
            (Kind::Signed(2), &(-300_i16).to_le_bytes(), -300.0),
            (Kind::Unsigned(2), &40_000_u16.to_le_bytes(), 40_000.0),
            (Kind::Signed(4), &i32::MIN.to_le_bytes(), -2_147_483_648.0),
            (Kind::Unsigned(4), &u32::MAX.to_le_bytes(), 4_294_967_295.0),
            (Kind::Signed(8), &(-1_i64 << 40).to_le_bytes(), -1_099_511_627_776.0),
            (Kind::Unsigned(8), &(1_u64 << 63).to_le_bytes(), 9_223_372_036_854_775_808.0),
            (Kind::Float(4), &0.5_f32.to_le_bytes(), 0.5),
            (Kind::Float(8), &(-1e300_f64).to_le_bytes(), -1e300),
        ] {
            let big: Vec<u8> = little.iter().rev().copied().collect();
            for bits in [Order::Little.bits(little), Order::Big.bits(&big)] {
                assert_eq!(kind.real(bits).to_bits(), f64::to_bits(value), "{kind}");
                if kind.is_whole() {
                    assert_eq!(kind.whole(bits), value as i64, "{kind}");
                }
            }
            assert_eq!((kind.size(), Kind::of_name(&kind.to_string())), (little.len(), Some(kind)));
        }
    }
}
