//! Tests of several modules at once that see more than is public.

mod certificate;
mod curved;
mod diagram;
mod farthest;
mod features;
mod geodesics;
mod net;
mod parts;
mod realisation;
mod relaxation;
mod roads;
mod rdt;
mod star_set;
mod stopping;
mod surfaces;
mod wavy;
