//! voronaut in a browser: a worker asks by a text of JSON and bytes, and gets the like back.
//!
//! What is asked for is a command of the program with its options ([`voronaut_cli::Job`]), on files that the page holds. So a page
//! makes the mesh that the program makes, and shows what it says.

mod abi;
mod answer;
mod desk;
mod files;
mod request;
mod watch;

#[cfg(test)]
mod tests;

pub use desk::Desk;
pub use watch::Window;
