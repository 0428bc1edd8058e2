//! All tests of the program, in one, for there is one to link then.

mod adapt;
mod bad_input;
mod certificate;
mod coming_from;
mod common;
mod completions;
mod convert;
mod curved;
mod distance;
mod dual;
mod geodesic_edges;
mod good_input;
mod histograms;
mod interpolate;
mod limits;
mod metric;
mod options;
mod parts;
mod periodic;
mod protection;
mod remesh;
mod remesh_plane;
mod surfaces;
mod unmet;
mod view;
