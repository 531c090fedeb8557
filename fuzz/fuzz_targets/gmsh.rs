#![no_main]
membrane_contact_fuzz::fuzzer!("gmsh");
