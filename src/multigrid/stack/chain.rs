//! The membranes at one vertex: the nearest point in their cone (section 4 of the notes on stacks).

/// Membranes that have been pooled.
#[derive(Debug, Clone, Copy)]
struct Block {
    value: f64,
    weight: f64,
    end: usize,
}

/// Memory for [`project`](Self::project).
#[derive(Debug, Clone)]
pub(super) struct Pool {
    blocks: Vec<Block>,
}

impl Pool {
    pub(super) fn new(membranes: usize) -> Self {
        Self { blocks: Vec::with_capacity(membranes) }
    }

    /// Minimises `sum_i d_i (v_i - z_i)^2` subject to `upper >= v_1 >= .. >= v_n >= lower`; `v` takes the place of `z`, and members
    /// that touch are equal to the last bit.
    ///
    /// Adjacent violators are pooled, then all is clipped, which is exact: see the proof in the notes.
    #[inline(always)]
    pub(super) fn project(&mut self, z: &mut [f64], d: &[f64], [lower, upper]: [f64; 2]) {
        if let ([z], [_]) = (&mut *z, d) {
            *z = clip(*z, [lower, upper]);
            return;
        }
        self.blocks.clear();
        for (i, (&value, &weight)) in z.iter().zip(d).enumerate() {
            let mut new = Block { value, weight, end: i + 1 };
            while let Some(above) = self.blocks.last()
                && above.value < new.value
            {
                let weight = above.weight + new.weight;
                let value = (above.weight * above.value + new.weight * new.value) / weight;
                new = Block { value, weight, end: i + 1 };
                self.blocks.pop();
            }
            self.blocks.push(new);
        }
        let mut start = 0;
        for block in &self.blocks {
            z[start..block.end].fill(clip(block.value, [lower, upper]));
            start = block.end;
        }
    }
}

#[inline(always)]
fn clip(value: f64, [lower, upper]: [f64; 2]) -> f64 {
    let value = if value < lower { lower } else { value };
    if value > upper { upper } else { value }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// Rounding of means of numbers of size one.
    const ROUNDING: f64 = 1e-13;

    fn distance_sq(v: &[f64], z: &[f64], d: &[f64]) -> f64 {
        v.iter().zip(z).zip(d).map(|((v, z), d)| d * (v - z).powi(2)).sum()
    }

    /// All ways to cut the chain into blocks, each at its mean or at a bound: the nearest that is in the cone.
    fn by_brute_force(z: &[f64], d: &[f64], [lower, upper]: [f64; 2]) -> Vec<f64> {
        let n = z.len();
        let mut best: Option<(f64, Vec<f64>)> = None;
        for cuts in 0..1usize << (n - 1) {
            let mut v = Vec::new();
            let mut start = 0;
            for end in (1..=n).filter(|&end| end == n || cuts >> (end - 1) & 1 == 1) {
                let weight: f64 = d[start..end].iter().sum();
                let mean = (start..end).map(|i| d[i] * z[i]).sum::<f64>() / weight;
                v.extend(std::iter::repeat_n(mean.clamp(lower, upper), end - start));
                start = end;
            }
            let is_in_cone = v.windows(2).all(|pair| pair[0] >= pair[1]);
            let distance = distance_sq(&v, z, d);
            if is_in_cone && best.as_ref().is_none_or(|(least, _)| distance < *least) {
                best = Some((distance, v));
            }
        }
        best.expect("one block is in the cone").1
    }

    fn projected(z: &[f64], d: &[f64], bounds: [f64; 2]) -> Vec<f64> {
        let mut v = z.to_vec();
        Pool::new(z.len()).project(&mut v, d, bounds);
        v
    }

    fn off(v: &[f64], w: &[f64]) -> f64 {
        v.iter().zip(w).map(|(v, w)| (v - w).abs()).fold(0.0, f64::max)
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(400))]

        #[test]
        fn it_is_the_nearest_point_of_the_cone(
            chain in prop::collection::vec((-1.0..1.0f64, -3.0..3.0f64), 1..8),
            bounds in (-1.2..1.2f64, 0.0..1.5f64, prop::array::uniform2(any::<bool>())),
        ) {
            let z: Vec<f64> = chain.iter().map(|&(z, _)| z).collect();
            let d: Vec<f64> = chain.iter().map(|&(_, exponent)| 10f64.powf(exponent)).collect();
            let (lower, width, [has_lower, has_upper]) = bounds;
            let bounds = [
                if has_lower { lower } else { f64::NEG_INFINITY },
                if has_upper { lower + width } else { f64::INFINITY },
            ];
            let expected = by_brute_force(&z, &d, bounds);
            let found = projected(&z, &d, bounds);
            prop_assert!(off(&found, &expected) < ROUNDING, "{found:?} {expected:?}");
            // What touches does so to the last bit, and a second projection changes nothing.
            let touching = expected.windows(2).zip(found.windows(2)).filter(|(e, _)| e[0] == e[1]);
            prop_assert!(touching.into_iter().all(|(_, f)| f[0] == f[1]));
            prop_assert_eq!(&projected(&found, &d, bounds), &found);
        }
    }

    /// The negative test: clipping first and pooling then is not it, and neither is pooling without weights.
    #[test]
    fn the_order_of_the_steps_and_the_weights_count() {
        let (z, d, bounds) = ([-3.0, 1.0], [1.0, 1.0], [0.0, f64::INFINITY]);
        let clipped: Vec<f64> = z.iter().map(|&z| clip(z, bounds)).collect();
        let wrong = projected(&clipped, &d, bounds);
        assert!(off(&wrong, &by_brute_force(&z, &d, bounds)) > 0.1, "{wrong:?}");
        assert_eq!(projected(&z, &d, bounds), [0.0; 2]);
        let heavy = [1.0, 9.0];
        let unweighted = projected(&z, &d, [-9.0, 9.0]);
        assert!(off(&unweighted, &by_brute_force(&z, &heavy, [-9.0, 9.0])) > 0.1);
    }
}
