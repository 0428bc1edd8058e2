//! What the worker calls, and what it is called by. Memory is the module's own: the worker writes into a list that it asked for, and
//! reads from one that stays until the next question. No operation here is unsafe; declarations of what others link to are.
#![cfg(target_family = "wasm")]
#![allow(unsafe_code, unreachable_pub, reason = "names that the worker links to")]

use crate::{Desk, Window};
use std::sync::{Mutex, MutexGuard, PoisonError};

#[link(wasm_import_module = "worker")]
unsafe extern "C" {
    /// Seconds.
    safe fn now() -> f64;
    /// A stage begins: its name, and units of work.
    safe fn stage(name: *const u8, bytes: usize, total: f64);
    /// Units of it are done.
    safe fn done(units: f64);
    /// Points, three numbers each, and triangles.
    safe fn sketch(points: *const [f64; 3], count: usize, triangles: *const [u32; 3], triangle_count: usize);
    /// What goes wrong right now, before the module ends.
    safe fn failed(text: *const u8, bytes: usize);
}

struct Worker;

impl Window for Worker {
    fn seconds(&self) -> f64 {
        now()
    }

    fn stage(&self, name: &str, total: u64) {
        stage(name.as_ptr(), name.len(), total as f64);
    }

    fn done(&self, units: u64) {
        done(units as f64);
    }

    fn sketch(&self, points: &[[f64; 3]], triangles: &[[u32; 3]]) {
        sketch(points.as_ptr(), points.len(), triangles.as_ptr(), triangles.len());
    }
}

/// The question, the answer, and what is kept in between.
struct Held {
    question: Vec<u8>,
    answer: Vec<u8>,
    desk: Option<Desk>,
}

static HELD: Mutex<Held> = Mutex::new(Held { question: Vec::new(), answer: Vec::new(), desk: None });

fn held() -> MutexGuard<'static, Held> {
    HELD.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Room for a question of so many bytes.
#[unsafe(no_mangle)]
pub extern "C" fn question(bytes: usize) -> *mut u8 {
    let mut held = held();
    held.question = vec![0; bytes];
    held.question.as_mut_ptr()
}

/// Does what the question asks; returns the length of the answer.
#[unsafe(no_mangle)]
pub extern "C" fn perform() -> usize {
    std::panic::set_hook(Box::new(|panic| {
        let text = panic.to_string();
        failed(text.as_ptr(), text.len());
    }));
    let mut held = held();
    let question = std::mem::take(&mut held.question);
    held.answer = Vec::new();
    held.answer = held.desk.get_or_insert_default().asked(&question, &Worker);
    held.answer.len()
}

/// Where the answer is.
#[unsafe(no_mangle)]
pub extern "C" fn answer() -> *const u8 {
    held().answer.as_ptr()
}
