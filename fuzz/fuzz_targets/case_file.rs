#![no_main]
membrane_contact_fuzz::fuzzer!("case_file");
