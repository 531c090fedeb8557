//! The integration tests, in one binary.

mod common;

#[cfg(feature = "cli")]
mod adapt;
mod adaptive_hierarchy;
#[cfg(feature = "cli")]
mod answer;
mod backends;
#[cfg(feature = "cli")]
mod bad_input;
#[cfg(feature = "cli")]
mod bench;
mod custom_backend;
mod exact;
mod hostile_numbers;
mod invariance;
mod layers;
#[cfg(feature = "cli")]
mod manifest;
#[cfg(feature = "cli")]
mod plate;
#[cfg(feature = "cli")]
mod program;
mod quadrature;
#[cfg(feature = "cli")]
mod readme;
mod resume;
#[cfg(feature = "cli")]
mod same_bytes;
mod stability;
#[cfg(feature = "cli")]
mod surroundings;
#[cfg(feature = "cli")]
mod theory;
#[cfg(feature = "cli")]
mod timeless;
