//! The bytes of an array as a file holds them: text, plain or compressed in blocks.

use crate::codec::Order;
use flate2::read::ZlibDecoder;
use std::io::{self, ErrorKind, Read};

/// How a file holds binary arrays.
#[derive(Clone, Copy, Debug)]
pub(super) struct Layout {
    pub(super) order: Order,
    /// Whether sizes have 64 bits, not 32.
    pub(super) is_wide: bool,
    pub(super) is_compressed: bool,
}

/// An array as it stands in the file.
pub(super) enum Stored {
    Text(String),
    Plain(Vec<u8>),
    /// Blocks that are compressed by zlib, one behind the other: how many bytes each has compressed and uncompressed.
    Blocks(Vec<[u64; 2]>, Vec<u8>),
    /// In the section `AppendedData`, which is not yet read, from this byte on.
    Appended(u64),
}

impl Stored {
    /// Reads a binary array, with the sizes before it. Memory follows what is there, not what they say.
    ///
    /// # Errors
    /// What `source` says; [`ErrorKind::UnexpectedEof`] where it ends before the array does.
    pub(super) fn read(source: &mut dyn Read, layout: Layout) -> io::Result<Self> {
        let length = size(source, layout)?;
        if !layout.is_compressed {
            return Ok(Self::Plain(exactly(source, length)?));
        }
        if length == 0 {
            return Ok(Self::Plain(Vec::new()));
        }
        // The last block is as large as the others where its size is 0.
        let (block, last) = (size(source, layout)?, size(source, layout)?);
        let (mut sizes, mut all) = (Vec::new(), 0_u64);
        for i in 1..=length {
            let compressed = size(source, layout)?;
            sizes.push([compressed, if i == length && last != 0 { last } else { block }]);
            all = all.checked_add(compressed).ok_or(ErrorKind::UnexpectedEof)?;
        }
        Ok(Self::Blocks(sizes, exactly(source, all)?))
    }

    /// The bytes of a binary array, of which so many are `needed`: no more are decompressed.
    ///
    /// # Errors
    /// What is wrong: other sizes, or what zlib did not write.
    pub(super) fn bytes(self, needed: u64) -> Result<Vec<u8>, String> {
        let held = match &self {
            Self::Plain(bytes) => bytes.len() as u128,
            Self::Blocks(sizes, _) => sizes.iter().map(|[_, size]| u128::from(*size)).sum(),
            Self::Text(_) | Self::Appended(_) => 0,
        };
        if held != u128::from(needed) {
            return Err(format!("holds {held} bytes, where {needed} are needed"));
        }
        match self {
            Self::Plain(bytes) => Ok(bytes),
            Self::Blocks(sizes, data) => decompressed(&sizes, &data),
            Self::Text(_) | Self::Appended(_) => Ok(Vec::new()),
        }
    }
}

fn decompressed(sizes: &[[u64; 2]], mut data: &[u8]) -> Result<Vec<u8>, String> {
    let mut bytes = Vec::new();
    for (i, &[length, size]) in (1..).zip(sizes) {
        let (block, before) = (format!("block {i} of {}", sizes.len()), bytes.len() as u64);
        let (compressed, others) = data.split_at(length as usize);
        data = others;
        // One byte more shows that there are too many.
        let read = ZlibDecoder::new(compressed).take(size.saturating_add(1)).read_to_end(&mut bytes);
        read.map_err(|error| format!("does not decompress in {block}: {error}"))?;
        if bytes.len() as u64 - before != size {
            return Err(format!("does not decompress to {size} bytes in {block}"));
        }
    }
    Ok(bytes)
}

/// A size of the head of an array.
fn size(source: &mut dyn Read, layout: Layout) -> io::Result<u64> {
    let mut bytes = [0; 8];
    let width = if layout.is_wide { 8 } else { 4 };
    source.read_exact(&mut bytes[..width])?;
    Ok(layout.order.bits(&bytes[..width]))
}

fn exactly(source: &mut dyn Read, count: u64) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    let read = source.take(count).read_to_end(&mut bytes)?;
    if (read as u64) < count { Err(ErrorKind::UnexpectedEof.into()) } else { Ok(bytes) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use flate2::{Compression, write::ZlibEncoder};
    use std::io::Write;

    fn compressed(bytes: &[u8]) -> Vec<u8> {
        let mut encoder = ZlibEncoder::new(Vec::new(), Compression::default());
        encoder.write_all(bytes).unwrap();
        encoder.finish().unwrap()
    }

    /// An array of one block and one of the rest.
    fn file(order: Order, is_wide: bool, sizes: [u64; 2], blocks: [&[u8]; 2]) -> Vec<u8> {
        let blocks = blocks.map(compressed);
        let heads = [2, sizes[0], sizes[1], blocks[0].len() as u64, blocks[1].len() as u64];
        let width = if is_wide { 8 } else { 4 };
        let bytes = heads.iter().flat_map(|size| match order {
            Order::Little => size.to_le_bytes()[..width].to_vec(),
            Order::Big => size.to_be_bytes()[8 - width..].to_vec(),
        });
        bytes.chain(blocks.concat()).collect()
    }

    #[test]
    fn blocks_in_all_layouts() {
        for (order, is_wide) in [(Order::Little, false), (Order::Little, true), (Order::Big, false), (Order::Big, true)]
        {
            let layout = Layout { order, is_wide, is_compressed: true };
            for (sizes, blocks, expected) in
                [([4, 2], [&b"abcd"[..], b"ef"], "abcdef"), ([4, 0], [b"abcd", b"efgh"], "abcdefgh")]
            {
                let stored = Stored::read(&mut file(order, is_wide, sizes, blocks).as_slice(), layout).unwrap();
                assert_eq!(stored.bytes(expected.len() as u64).unwrap(), expected.as_bytes());
            }
        }
    }

    #[test]
    fn lies_of_compressed_arrays() {
        let layout = Layout { order: Order::Little, is_wide: true, is_compressed: true };
        let message = |sizes, blocks: [&[u8]; 2], needed| {
            Stored::read(&mut file(Order::Little, true, sizes, blocks).as_slice(), layout).unwrap().bytes(needed)
        };
        assert_eq!(message([4, 2], [b"abcd", b"ef"], 7).unwrap_err(), "holds 6 bytes, where 7 are needed");
        let huge = u64::MAX;
        let expected = format!("holds {} bytes, where 8 are needed", 2 * u128::from(huge));
        assert_eq!(message([huge, huge], [b"abcd", b"ef"], 8).unwrap_err(), expected);
        // A bomb: far more than it says.
        let zeros = vec![0; 1 << 20];
        let expected = "does not decompress to 4 bytes in block 1 of 2";
        assert_eq!(message([4, 2], [&zeros, b"ef"], 6).unwrap_err(), expected);
        let expected = "does not decompress to 4 bytes in block 2 of 2";
        assert_eq!(message([4, 0], [b"abcd", b"ef"], 8).unwrap_err(), expected);
        let mut whole = file(Order::Little, true, [4, 2], [b"abcd", b"ef"]);
        for length in 0..whole.len() {
            assert!(Stored::read(&mut &whole[..length], layout).is_err(), "{length}");
        }
        whole[42] ^= 0xff;
        let damaged = Stored::read(&mut whole.as_slice(), layout).unwrap().bytes(6).unwrap_err();
        assert!(damaged.starts_with("does not decompress in block 1 of 2: "), "{damaged}");
        whole[..8].fill(0xff);
        assert!(Stored::read(&mut whole.as_slice(), layout).is_err());
    }
}
