//! Files that are written, and files of Gmsh.
