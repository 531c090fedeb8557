//! Files of a run but for what the clock says: these are the same in every run.

use std::path::Path;

use serde_json::Value;

/// The bytes of the file `name`, without the times in it.
pub fn timeless(name: &str, bytes: Vec<u8>) -> Vec<u8> {
    match Path::new(name).extension().and_then(|extension| extension.to_str()) {
        Some("csv") => table_without_times(&bytes).into_bytes(),
        Some("json") => summary_without_times(&bytes).into_bytes(),
        _ => bytes,
    }
}

/// The names of columns and keys that hold times.
fn is_time(name: &str) -> bool {
    name.contains("seconds")
}

fn table_without_times(bytes: &[u8]) -> String {
    let mut reader = csv::Reader::from_reader(bytes);
    let headers = reader.headers().expect("a table has a head").clone();
    let kept = |row: &csv::StringRecord| {
        let cells = headers.iter().zip(row).filter(|(name, _)| !is_time(name)).map(|(_, cell)| cell);
        cells.collect::<Vec<_>>().join(",") + "\n"
    };
    kept(&headers) + &reader.records().map(|row| kept(&row.expect("a row"))).collect::<String>()
}

fn summary_without_times(bytes: &[u8]) -> String {
    let mut summary: Value = serde_json::from_slice(bytes).expect("JSON");
    summary.as_object_mut().expect("a summary has fields").retain(|name, _| !is_time(name));
    summary.to_string()
}

#[test]
fn times_are_left_out_and_nothing_else() {
    assert_eq!(timeless("a.csv", b"a,solve_seconds,b\n1,2,3\n".to_vec()), b"a,b\n1,3\n");
    assert_eq!(timeless("a.json", br#"{"a": 1, "seconds": {"mesh": 2}}"#.to_vec()), br#"{"a":1}"#);
    assert_eq!(timeless("a.md", b"seconds".to_vec()), b"seconds");
}
