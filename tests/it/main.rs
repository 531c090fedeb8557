//! The integration tests, in one binary.

mod common;

mod adapt;
mod adaptive_hierarchy;
mod answer;
mod backends;
mod bad_input;
mod bench;
mod cones;
mod custom_backend;
mod exact;
mod folders;
mod gmsh_data;
mod hostile_numbers;
mod hostile_records;
mod invariance;
mod layers;
mod manifest;
mod mesh_files;
mod pictures;
mod plate;
mod program;
mod quadrature;
#[path = "../../src/numeric/random.rs"]
mod random;
mod readme;
mod resume;
mod same_bytes;
mod stability;
mod stack_cases;
mod stacks;
mod surroundings;
mod terminal;
mod theory;
mod timeless;
