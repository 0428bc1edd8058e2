//! All tests of what is public, in one program, for there is one to link then.

mod architecture;
mod damage;
mod interpolation;
mod periodic;
mod random_domains;
mod surfaces;
mod threads;
mod unit_meshes;
