use proptest::prelude::*;

use super::coarse::CoarseLevels;
use super::conjugate::{Conjugate, precondition};
use super::level::StackLevel;
use super::levels::StackLevels;
use super::partition::Partition;
use super::sweep::Sweeps;
use crate::discretization::StackDiscretization;
use crate::mesh::samples::{irregular, with_sides_and_patch};
use crate::multigrid::hierarchy::Genealogy;
use crate::numeric::Random;
use crate::problem::samples::stack::drawn;

/// Rounding of sums of products of size one, relative to their terms.
const ROUNDING: f64 = 1e-10;

/// Blocks at random: of membranes that are free, next to each other, some of them stuck. Vertices far from the seed's corner keep what
/// they have, so that a partition can change in part.
fn shuffle(level: &StackLevel, partition: &mut Partition, random: &mut Random, one_in: usize) -> Vec<u32> {
    let mut changed = Vec::new();
    let rows = level.rows();
    let mut chunks: Vec<_> = partition.chunks(rows).collect();
    for a in 0..rows {
        if random.below(one_in) != 0 {
            continue;
        }
        let has_changed = chunks[0].renew(a, |blocks| {
            level.for_chains(a, |start, end, _| {
                let mut first = start;
                for i in start..end {
                    if i + 1 == end || random.below(2) == 0 {
                        if random.below(4) != 0 {
                            blocks.add(first, i + 1);
                        }
                        first = i + 1;
                    }
                }
            });
        });
        if has_changed {
            changed.push(a as u32);
        }
    }
    changed
}

/// A functional that is zero where nothing moves, one value for each member of a block or not.
fn functional(partition: &Partition, rows: usize, random: &mut Random) -> Vec<f64> {
    let n = partition.membranes();
    let mut values = vec![0.0; rows * n];
    for a in 0..rows {
        for (i, &len) in partition.lens(a).iter().enumerate() {
            for member in i..i + len as usize {
                values[a * n + member] = random.between(-1.0, 1.0);
            }
        }
    }
    values
}

fn dot(x: &[f64], y: &[f64]) -> f64 {
    x.iter().zip(y).map(|(x, y)| x * y).sum()
}

/// Whether members of a block have one value, and nothing else moves.
fn moves_in_blocks(partition: &Partition, rows: usize, c: &[f64]) -> bool {
    let n = partition.membranes();
    (0..rows).flat_map(|a| (0..n).map(move |i| (a, i))).all(|(a, i)| {
        let block = partition.block(a, i);
        if partition.len(block) == 0 { c[a * n + i] == 0.0 } else { c[a * n + i] == c[block] }
    })
}

struct Case {
    levels: StackLevels,
    random: Random,
}

fn case(drawn: &crate::problem::samples::stack::Drawn, cells: usize, refinements: usize, seed: u64) -> Case {
    let mesh = (0..refinements).fold(irregular(cells), |mesh, _| mesh.refine().unwrap().mesh);
    let d = StackDiscretization::new(&drawn.problem(1.0, 0.0), with_sides_and_patch(mesh)).unwrap();
    Case { levels: StackLevels::new(&d, &Genealogy::of(d.mesh())), random: Random::new(seed) }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// On truncated levels: the cycle is symmetric and definite, so that conjugate gradients may use it; what it corrects moves in
    /// blocks, and each correction lowers the energy.
    #[test]
    fn a_correction_lowers_the_energy(
        drawn in drawn(), cells in 3..8usize, refinements in 0..3usize, seed in any::<u64>(),
    ) {
        let Case { levels, mut random } = case(&drawn, cells, refinements, seed);
        let finest = levels.finest();
        let level = levels.problem(finest);
        let mut partition = Partition::new(level.rows(), level.membranes());
        let changed = shuffle(level, &mut partition, &mut random, 1);
        let mut coarse = CoarseLevels::new(&levels);
        coarse.restart(finest);
        coarse.follow(finest, level, &partition, &changed).unwrap();
        let mut sweeps = Sweeps::new(level);
        let r: [Vec<f64>; 2] = [0, 1].map(|_| functional(&partition, level.rows(), &mut random));
        let mut left = r[0].clone();
        let mut z: [Vec<f64>; 2] = [left.clone(), left.clone()];
        for k in 0..2 {
            precondition((finest, level), &mut sweeps, &mut coarse, &partition, &r[k], &mut z[k], &mut left).unwrap();
            prop_assert!(moves_in_blocks(&partition, level.rows(), &z[k]));
            prop_assert!(dot(&r[k], &z[k]) >= 0.0);
        }
        let size = (dot(&r[0], &z[0]) * dot(&r[1], &z[1])).sqrt();
        prop_assert!((dot(&r[0], &z[1]) - dot(&r[1], &z[0])).abs() <= ROUNDING * size);
        // The energy of the correction, and what is left of the residual.
        let mut conjugate = Conjugate::new(left.len());
        let mut residual = r[0].clone();
        conjugate.solve((finest, level), &mut sweeps, &mut coarse, &partition, &mut residual).unwrap();
        let c = &conjugate.correction;
        sweeps.multiply(c, &mut left);
        let energy = 0.5 * dot(c, &left) - dot(&r[0], c);
        prop_assert!(energy <= 0.0, "{energy:e}");
        let moving = partition.blocks();
        prop_assert!(moving == 0 || energy < 0.0);
        prop_assert!(moves_in_blocks(&partition, level.rows(), c));
    }

    /// Following a change is as good as starting anew.
    #[test]
    fn rows_follow_the_partition(
        drawn in drawn(), cells in 3..8usize, refinements in 0..3usize, seed in any::<u64>(),
    ) {
        let Case { levels, mut random } = case(&drawn, cells, refinements, seed);
        let finest = levels.finest();
        let level = levels.problem(finest);
        let mut partition = Partition::new(level.rows(), level.membranes());
        let mut following = CoarseLevels::new(&levels);
        following.restart(finest);
        let mut all: Vec<u32> = Vec::new();
        for one_in in [1, 20, 100] {
            let changed = shuffle(level, &mut partition, &mut random, one_in);
            let before = following.clone_matrices();
            following.follow(finest, level, &partition, &changed).unwrap();
            all.extend(&changed);
            let mut anew = CoarseLevels::new(&levels);
            anew.restart(finest);
            anew.follow(finest, level, &partition, &(0..level.rows() as u32).collect::<Vec<_>>()).unwrap();
            prop_assert!(following.clone_matrices() == anew.clone_matrices());
            // The negative test: without following they are others.
            prop_assert!(changed.is_empty() || one_in > 1 || before != anew.clone_matrices());
        }
    }
}
