//! The logarithms of one series.

/// Abscissae whose decimal logarithms differ by less give no slope.
const SAME: f64 = 1e-9;

/// A series in decimal logarithms; `None` where there is none.
pub(super) struct Curve {
    levels: Vec<Option<[f64; 2]>>,
    /// The abscissae where there is rounding only.
    at_rounding: Vec<f64>,
}

impl Curve {
    /// The curve of `values` over `h`.
    pub(super) fn new(h: &[f64], values: &[f64]) -> Curve {
        let logarithm = |value: f64| (value > 0.0 && value.is_finite()).then(|| value.log10());
        let level = |(&h, &value): (&f64, &f64)| Some([logarithm(h)?, logarithm(value)?]);
        Curve { levels: h.iter().zip(values).map(level).collect(), at_rounding: Vec::new() }
    }

    /// The same curve, where what is below `floor` is taken for rounding.
    pub(super) fn above(self, floor: f64) -> Curve {
        let below = |point: &[f64; 2]| point[1] < floor;
        Curve {
            at_rounding: self.points().filter(below).map(|point| point[0]).collect(),
            levels: self.levels.into_iter().map(|level| level.filter(|point| !below(point))).collect(),
        }
    }

    /// The abscissae where there is rounding only.
    pub(super) fn at_rounding(&self) -> impl Iterator<Item = f64> + '_ {
        self.at_rounding.iter().copied()
    }

    /// Whether nothing but rounding is left on the last level.
    pub(super) fn ends_at_rounding(&self) -> bool {
        !self.at_rounding.is_empty() && self.levels.last().is_none_or(Option::is_none)
    }

    /// The curve through points in the order of their abscissae; those that have no logarithm are left out.
    pub(super) fn through(points: &[[f64; 2]]) -> Curve {
        let mut points = points.to_vec();
        points.sort_by(|p, q| p[0].total_cmp(&q[0]));
        let [x, y] = [0, 1].map(|axis| points.iter().map(|point| point[axis]).collect::<Vec<f64>>());
        Curve { levels: Curve::new(&x, &y).points().map(Some).collect(), at_rounding: Vec::new() }
    }

    /// The points that can be drawn.
    pub(super) fn points(&self) -> impl Iterator<Item = [f64; 2]> + '_ {
        self.levels.iter().flatten().copied()
    }

    /// Neighbouring levels that can both be drawn.
    pub(super) fn segments(&self) -> impl DoubleEndedIterator<Item = [[f64; 2]; 2]> + '_ {
        self.levels.windows(2).filter_map(|pair| Some([pair[0]?, pair[1]?]))
    }

    /// The slope of the last segment.
    pub(super) fn last_slope(&self) -> Option<f64> {
        let [from, to] = self.segments().next_back()?;
        let run = to[0] - from[0];
        (run.abs() > SAME).then(|| (to[1] - from[1]) / run)
    }

    /// The rightmost point.
    pub(super) fn end(&self) -> Option<[f64; 2]> {
        self.points().max_by(|p, q| p[0].total_cmp(&q[0]))
    }

    /// The lowest place of the curve between two abscissae, infinite if it does not reach there.
    pub(super) fn lowest_between(&self, [left, right]: [f64; 2]) -> f64 {
        const STEPS: usize = 32;
        let sample = |[p, q]: [[f64; 2]; 2], step: usize| {
            let along = step as f64 / STEPS as f64;
            [0, 1].map(|axis| p[axis] + along * (q[axis] - p[axis]))
        };
        let on_segments = self.segments().flat_map(|ends| (0..=STEPS).map(move |step| sample(ends, step)));
        let near = self.points().chain(on_segments).filter(|p| (left..=right).contains(&p[0]));
        near.map(|p| p[1]).fold(f64::INFINITY, f64::min)
    }
}
