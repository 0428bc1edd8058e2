//! What files are written by: one number after the other, as words or as bytes.

use super::kinds::{Form, Kind};
use rayon::prelude::*;
use std::fmt;
use std::io::{self, Write};

/// Rows that a thread writes at once, and how many times as many are in memory.
const ROWS: usize = 1024;
const PARTS: usize = 64;

/// A file that is being written, row by row.
pub(crate) struct Sink<'a> {
    out: &'a mut dyn Write,
    /// The rows that are not written yet.
    rows: Rows,
    /// Bytes of all numbers of a binary file before.
    written: u64,
}

/// Rows of numbers, one after the other.
pub(crate) struct Rows {
    form: Form,
    bytes: Vec<u8>,
    /// Where the last row starts.
    row: usize,
}

/// A type of numbers that are written, in binary files with the least byte first.
pub(crate) trait Number: Copy {
    /// What it is in binary files.
    const KIND: Kind;

    fn put_bytes(self, to: &mut Vec<u8>);

    fn put_word(self, to: &mut Vec<u8>);
}

/// A number in the shortest form that reads back as itself; huge and tiny ones with an exponent.
pub(crate) struct Shortest(pub(crate) f64);

macro_rules! numbers {
    ($($number:ty, $kind:expr, $put_word:path;)*) => {$(
        impl Number for $number {
            const KIND: Kind = $kind;

            fn put_bytes(self, to: &mut Vec<u8>) {
                to.extend_from_slice(&self.to_le_bytes());
            }

            fn put_word(self, to: &mut Vec<u8>) {
                $put_word(self, to);
            }
        }
    )*};
}

numbers! {
    u8, Kind::Unsigned(1), put_whole;
    i32, Kind::Signed(4), put_whole;
    u32, Kind::Unsigned(4), put_whole;
    i64, Kind::Signed(8), put_whole;
    u64, Kind::Unsigned(8), put_whole;
    f32, Kind::Float(4), put_shown;
    f64, Kind::Float(8), put_real;
}

fn put_whole(number: impl itoa::Integer, to: &mut Vec<u8>) {
    to.extend_from_slice(itoa::Buffer::new().format(number).as_bytes());
}

fn put_real(number: f64, to: &mut Vec<u8>) {
    put_shown(Shortest(number), to);
}

fn put_shown(number: impl fmt::Display, to: &mut Vec<u8>) {
    write!(to, "{number}").expect("memory takes all");
}

impl<'a> Sink<'a> {
    /// A file in which nothing is yet.
    pub(crate) fn new(form: Form, out: &'a mut dyn Write) -> Self {
        Self { out, rows: Rows::new(form), written: 0 }
    }

    pub(crate) fn is_binary(&self) -> bool {
        self.rows.form == Form::Binary
    }

    /// How many bytes the numbers of a binary file have so far.
    pub(crate) fn written(&self) -> u64 {
        self.written + if self.is_binary() { self.rows.bytes.len() as u64 } else { 0 }
    }

    /// Ends the row, and then a line of text, be the file binary or not.
    pub(crate) fn line(&mut self, line: fmt::Arguments<'_>) -> io::Result<()> {
        self.end_row()?;
        writeln!(self.out, "{line}")
    }

    /// The next number of the row; in text a word.
    pub(crate) fn put<T: Number>(&mut self, number: T) {
        self.rows.put(number);
    }

    /// The next numbers of the row, one by one.
    pub(crate) fn put_all<T: Number>(&mut self, numbers: impl IntoIterator<Item = T>) {
        self.rows.put_all(numbers);
    }

    /// The last numbers of the row.
    pub(crate) fn row<T: Number>(&mut self, numbers: impl IntoIterator<Item = T>) -> io::Result<()> {
        self.put_all(numbers);
        self.end_row()
    }

    /// Ends the row, with which its numbers are written: in text as a line, if there are any.
    pub(crate) fn end_row(&mut self) -> io::Result<()> {
        self.rows.end_row();
        self.out.write_all(&self.rows.bytes)?;
        self.written = self.written();
        self.rows.clear();
        Ok(())
    }

    /// So many rows, each filled by its number; by all threads.
    pub(crate) fn rows(&mut self, count: usize, fill: impl Fn(&mut Rows, usize) + Sync) -> io::Result<()> {
        self.end_row()?;
        let form = self.rows.form;
        let part = |first: usize| {
            let mut rows = Rows::new(form);
            for i in first..count.min(first + ROWS) {
                fill(&mut rows, i);
                rows.end_row();
            }
            rows
        };
        // All threads of the pool may be waiting for one that is none of them.
        let is_of_pool = rayon::current_thread_index().is_some();
        let firsts: Vec<usize> = (0..count).step_by(ROWS).collect();
        for firsts in firsts.chunks(PARTS) {
            let parts: Vec<Rows> = if is_of_pool {
                firsts.par_iter().map(|&first| part(first)).collect()
            } else {
                firsts.iter().map(|&first| part(first)).collect()
            };
            for rows in parts {
                self.rows = rows;
                self.end_row()?;
            }
        }
        Ok(())
    }
}

impl Rows {
    fn new(form: Form) -> Self {
        Self { form, bytes: Vec::new(), row: 0 }
    }

    /// The next number of the row; in text a word.
    pub(crate) fn put<T: Number>(&mut self, number: T) {
        if self.form == Form::Binary {
            return number.put_bytes(&mut self.bytes);
        }
        if self.bytes.len() > self.row {
            self.bytes.push(b' ');
        }
        number.put_word(&mut self.bytes);
    }

    /// The next numbers of the row, one by one.
    pub(crate) fn put_all<T: Number>(&mut self, numbers: impl IntoIterator<Item = T>) {
        numbers.into_iter().for_each(|number| self.put(number));
    }

    /// Ends the row: in text by a line's end, if it has numbers.
    fn end_row(&mut self) {
        if self.form == Form::Text && self.bytes.len() > self.row {
            self.bytes.push(b'\n');
        }
        self.row = self.bytes.len();
    }

    fn clear(&mut self) {
        self.bytes.clear();
        self.row = 0;
    }
}

impl fmt::Display for Shortest {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let size = self.0.abs();
        if size == 0.0 || (1e-5..1e16).contains(&size) { write!(f, "{}", self.0) } else { write!(f, "{:e}", self.0) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shortest_form_reads_back() {
        for value in [0.0, -0.0, 1.0, 0.1, 1e300, 5e-324, -1.0 / 3.0, 123_456_789.123_456_79] {
            let text = Shortest(value).to_string();
            assert_eq!(text.parse::<f64>().unwrap().to_bits(), value.to_bits(), "{text}");
            assert!(text.len() < 26, "{text}");
        }
    }

    #[test]
    fn many_rows_are_as_those_one_by_one() {
        let count = 2 * ROWS * PARTS + 7;
        let numbers = |i: usize| (0..i % 3).map(move |k| (i + k) as u32);
        let check = || {
            for form in [Form::Text, Form::Binary] {
                let [mut one_by_one, mut at_once] = [Vec::new(), Vec::new()];
                let mut sink = Sink::new(form, &mut one_by_one);
                (0..count).for_each(|i| sink.row(numbers(i)).unwrap());
                let mut other = Sink::new(form, &mut at_once);
                other.rows(count, |rows, i| rows.put_all(numbers(i))).unwrap();
                assert_eq!(sink.written(), other.written());
                assert_eq!(one_by_one, at_once);
            }
        };
        check();
        rayon::ThreadPoolBuilder::new().num_threads(3).build().unwrap().install(check);
    }

    #[test]
    fn rows_are_lines_in_text_only() {
        let written = |form| {
            let mut out = Vec::new();
            let mut sink = Sink::new(form, &mut out);
            sink.line(format_args!("head")).unwrap();
            sink.put(7_u8);
            sink.row([0.5, 1e20]).unwrap();
            sink.end_row().unwrap();
            sink.row([-1_i32]).unwrap();
            assert_eq!(sink.written(), if form == Form::Binary { 21 } else { 0 });
            out
        };
        assert_eq!(written(Form::Text), b"head\n7 0.5 1e20\n-1\n");
        let numbers = [&[7], 0.5_f64.to_le_bytes().as_slice(), &1e20_f64.to_le_bytes(), &[0xff; 4]].concat();
        assert_eq!(written(Form::Binary), [b"head\n", numbers.as_slice()].concat());
    }
}
