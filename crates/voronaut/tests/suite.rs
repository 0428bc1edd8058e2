//! All tests of what is public, in one program, for there is one to link then.

mod architecture;
mod certificate;
mod damage;
mod diagram;
mod farthest;
mod features;
mod geodesics;
mod interpolation;
mod net;
mod parts;
mod random_domains;
mod rdt;
mod realisation;
mod relaxation;
mod roads;
mod star_set;
mod surfaces;
mod threads;
mod unit_meshes;
mod wavy;
