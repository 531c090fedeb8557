use std::io::{Cursor, Read};

use sprs::TriMat;
use zip::ZipArchive;

use super::*;
use crate::mesh::Mesh;
use crate::mesh::samples::irregular;
use crate::problem::{ContactProblem, Function};
use crate::qp::contact_qp;

/// A program with numbers that have no short decimal form.
fn with_program(check: impl FnOnce(&Mesh, &PairDiscretization, &QpProblem)) {
    let mesh = irregular(4);
    let height = Function::from_fn(|x, y| 1.0 / 3.0 + x + y);
    let load = Function::from_fn(|x, y| (x + 2.0 * y).exp());
    let problem =
        ContactProblem::builder().tension(1.1, 0.7).load(load, -3.3).height(height).build().unwrap();
    let d = PairDiscretization::new(&problem, mesh.clone()).unwrap();
    check(&mesh, &d, &contact_qp(&d));
}

/// A program whose `b` is not zero: none of contact, but of this form.
fn with_bounds() -> QpProblem {
    let matrix = |shape, entries: &[(usize, usize, f64)]| {
        let mut triplets = TriMat::new(shape);
        entries.iter().for_each(|&(row, column, value)| triplets.add_triplet(row, column, value));
        triplets.to_csc()
    };
    let p = matrix((2, 2), &[(0, 0, 2.0 / 3.0), (0, 1, -0.1), (1, 1, 1e-300)]);
    let a = matrix((3, 2), &[(0, 0, 1.0), (1, 0, -1e300), (2, 1, 1.0 / 7.0)]);
    let qp = QpProblem::new(p, vec![0.1, -0.2], a, vec![-1.0 / 3.0, 0.0, 2e-17]).unwrap();
    qp.with_constant(-1.0 / 7.0).unwrap()
}

/// Row, column and value of all entries of a full matrix given by its upper triangle.
fn both_triangles(upper: &CsMat<f64>) -> CsMat<f64> {
    let mut triplets = TriMat::new(upper.shape());
    for (&value, (row, column)) in upper.iter() {
        triplets.add_triplet(row, column, value);
        if row != column {
            triplets.add_triplet(column, row, value);
        }
    }
    triplets.to_csc()
}

struct Archive(ZipArchive<Cursor<Vec<u8>>>);

impl Archive {
    fn of(d: &PairDiscretization, qp: &QpProblem) -> Self {
        let mut bytes = Cursor::new(Vec::new());
        write_npz(d, qp, &mut bytes).unwrap();
        bytes.set_position(0);
        Self(ZipArchive::new(bytes).unwrap())
    }

    /// The shape and the values of an array.
    fn array<T: npyz::Deserialize>(&mut self, name: &str) -> (Vec<u64>, Vec<T>) {
        let mut bytes = Vec::new();
        self.0.by_name(&format!("{name}.npy")).unwrap().read_to_end(&mut bytes).unwrap();
        let array = npyz::NpyFile::new(&bytes[..]).unwrap();
        (array.shape().to_vec(), array.into_vec().unwrap())
    }

    fn matrix(&mut self, name: &str) -> CsMat<f64> {
        let indices = |(_, values): (Vec<u64>, Vec<i64>)| {
            values.into_iter().map(|value| value as usize).collect::<Vec<_>>()
        };
        let shape = indices(self.array(&format!("{name}_shape")));
        let start = indices(self.array(&format!("{name}_indptr")));
        let rows = indices(self.array(&format!("{name}_indices")));
        CsMat::new_csc((shape[0], shape[1]), start, rows, self.array(&format!("{name}_data")).1)
    }
}

#[test]
fn an_archive_holds_the_program_and_the_mesh_to_the_last_bit() {
    with_program(|mesh, d, qp| {
        let n = d.interior().len() as u64;
        let mut archive = Archive::of(d, qp);
        assert_eq!(archive.matrix("P"), both_triangles(qp.p_upper()));
        assert_ne!(archive.matrix("P"), *qp.p_upper(), "both triangles");
        assert_eq!(archive.matrix("A"), *qp.a());
        assert_eq!(archive.array("q"), (vec![2 * n], qp.q().to_vec()));
        assert_eq!(archive.array("b"), (vec![n], qp.b().to_vec()));
        let interior: Vec<i64> = d.interior().iter().map(|&a| a as i64).collect();
        assert_eq!(archive.array("interior"), (vec![n], interior));
        let dual_area: Vec<f64> = d.interior().iter().map(|&a| d.dual_area()[a]).collect();
        assert_eq!(archive.array("dual_area"), (vec![n], dual_area));
        let points: Vec<f64> = mesh.points().iter().flatten().copied().collect();
        assert_eq!(archive.array("points"), (vec![25, 2], points));
        let triangles: Vec<i64> = mesh.triangles().iter().flatten().map(|&a| a as i64).collect();
        assert_eq!(archive.array("triangles"), (vec![32, 3], triangles));
        let numbers = [("constant", qp.constant()), ("displacement_scale", qp.primal_scale())];
        for (name, value) in numbers.into_iter().chain([("force_scale", qp.dual_scale())]) {
            assert_eq!(archive.array(name), (vec![], vec![value]), "{name}");
        }
        let scales = d.scales();
        assert_eq!(qp.dual_scale(), scales.force_density * scales.dual_area);
        assert_eq!(archive.0.len(), 17, "and nothing else");
    });
}

#[test]
fn archives_are_the_same_in_every_run() {
    with_program(|_, d, qp| {
        let bytes = |qp: &QpProblem| Archive::of(d, qp).0.into_inner().into_inner();
        assert!(bytes(qp) == bytes(qp));
        assert!(bytes(qp) != bytes(&with_bounds()));
    });
}

fn matrix_market(qp: &QpProblem, part: QpPart) -> String {
    let mut bytes = Vec::new();
    write_matrix_market(qp, part, &mut bytes).unwrap();
    String::from_utf8(bytes).unwrap()
}

/// Reads by the reader of `sprs`, which mirrors a symmetric matrix.
fn read_matrix(text: &str) -> CsMat<f64> {
    sprs::io::read_matrix_market_from_bufread(&mut text.as_bytes()).unwrap().to_csc()
}

#[test]
fn matrix_market_files_hold_the_program_to_the_last_bit() {
    let check = |qp: &QpProblem| {
        assert_eq!(read_matrix(&matrix_market(qp, QpPart::P)), both_triangles(qp.p_upper()));
        assert_eq!(read_matrix(&matrix_market(qp, QpPart::A)), *qp.a());
        let constant = [qp.constant()];
        for (part, vector) in [(QpPart::Q, qp.q()), (QpPart::B, qp.b()), (QpPart::Constant, &constant)] {
            let text = matrix_market(qp, part);
            let mut lines = text.lines();
            assert_eq!(lines.next(), Some("%%MatrixMarket matrix array real general"));
            assert_eq!(lines.next(), Some(format!("{} 1", vector.len()).as_str()));
            let values: Vec<f64> = lines.map(|line| line.parse().unwrap()).collect();
            assert_eq!(values, vector);
        }
    };
    with_program(|_, _, qp| check(qp));
    check(&with_bounds());
}

#[test]
fn the_symmetric_matrix_is_written_by_its_lower_triangle() {
    let expected = "%%MatrixMarket matrix coordinate real symmetric\n2 2 3\n1 1 6.666666666666666e-1\n2 1 -1e-1\n2 2 1e-300\n";
    assert_eq!(matrix_market(&with_bounds(), QpPart::P), expected);
    assert!(matrix_market(&with_bounds(), QpPart::A).contains("coordinate real general\n3 2 3\n"));
}

#[test]
fn every_part_has_its_letter() {
    assert_eq!(QpPart::ALL.map(QpPart::letter), ['P', 'A', 'q', 'b', 'c']);
}

/// The data of a QPS file.
#[derive(Debug, Default)]
struct Qps {
    rows: Vec<String>,
    free: Vec<usize>,
    q: Vec<f64>,
    a: Vec<(usize, usize, f64)>,
    b: Vec<f64>,
    constant: f64,
    p: Vec<(usize, usize, f64)>,
    sections: Vec<String>,
}

impl Qps {
    /// Reads the free form, of which it knows what is used here: rows `c1`, ..., columns `x1`, ..., in their order.
    fn parse(text: &str) -> Self {
        let number = |word: &str| word[1..].parse::<usize>().unwrap() - 1;
        let mut qps = Self::default();
        for line in text.lines() {
            let words: Vec<&str> = line.split_whitespace().collect();
            if !line.starts_with(' ') {
                qps.sections.push(words[0].to_string());
                continue;
            }
            match (qps.sections.last().unwrap().as_str(), &words[..]) {
                ("ROWS", &[kind, name]) => qps.rows.push(format!("{kind} {name}")),
                ("COLUMNS", &[_, "obj", value]) => qps.q.push(value.parse().unwrap()),
                ("COLUMNS", &[column, row, value]) => {
                    qps.a.push((number(row), number(column), value.parse().unwrap()));
                }
                ("RHS", &["rhs", "obj", value]) => qps.constant = -value.parse::<f64>().unwrap(),
                ("RHS", &["rhs", row, value]) => {
                    qps.b.resize(number(row) + 1, 0.0);
                    *qps.b.last_mut().unwrap() = value.parse().unwrap();
                }
                ("BOUNDS", &["FR", "bnd", column]) => qps.free.push(number(column)),
                ("QUADOBJ", &[row, column, value]) => {
                    qps.p.push((number(row), number(column), value.parse().unwrap()));
                }
                (section, words) => panic!("{section}: {words:?}"),
            }
        }
        qps
    }
}

#[test]
fn a_qps_file_holds_the_program_to_the_last_bit() {
    let check = |qp: &QpProblem| {
        let mut bytes = Vec::new();
        write_qps(qp, &mut bytes).unwrap();
        let mut found = Qps::parse(std::str::from_utf8(&bytes).unwrap());
        let (variables, constraints) = (qp.q().len(), qp.b().len());
        assert_eq!(found.sections, ["NAME", "ROWS", "COLUMNS", "RHS", "BOUNDS", "QUADOBJ", "ENDATA"]);
        let rows = (1..=constraints).map(|row| format!("G c{row}"));
        assert_eq!(found.rows, std::iter::once("N obj".to_string()).chain(rows).collect::<Vec<_>>());
        assert_eq!(found.free, (0..variables).collect::<Vec<_>>(), "no variable is bounded by zero");
        assert_eq!(found.q, qp.q());
        found.b.resize(constraints, 0.0);
        assert_eq!(found.b, qp.b());
        assert_eq!(found.constant, qp.constant());
        assert_ne!(found.constant, 0.0);
        let entries = |matrix: &CsMat<f64>| {
            matrix.iter().map(|(&v, (row, column))| (row, column, v)).collect::<Vec<_>>()
        };
        assert_eq!(found.a, entries(qp.a()));
        assert_eq!(found.p, entries(qp.p_upper()), "one triangle");
    };
    with_program(|_, _, qp| check(qp));
    check(&with_bounds());
}

/// A writer that fails after some bytes, as on a full disk.
struct Full(usize);

impl Write for Full {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if self.0 < bytes.len() {
            return Err(io::Error::from(io::ErrorKind::StorageFull));
        }
        self.0 -= bytes.len();
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

#[test]
fn a_full_disk_is_reported() {
    let qp = with_bounds();
    for space in [0, 100] {
        assert!(write_qps(&qp, Full(space)).is_err());
        assert!(write_matrix_market(&qp, QpPart::A, Full(space / 2)).is_err());
    }
    assert!(
        write_qps(&qp, Full(10_000)).is_ok() && write_matrix_market(&qp, QpPart::A, Full(10_000)).is_ok()
    );
}
