//! Eight patches side by side: the values at the same point of each, in the lanes of a vector.

use std::ops::{Add, AddAssign, Mul, Sub};

/// Patches that are worked on at once.
pub(super) const LANES: usize = 8;

/// A number of double or single precision.
pub(super) trait Real:
    Copy
    + Default
    + PartialOrd
    + Send
    + Sync
    + Add<Output = Self>
    + AddAssign
    + Sub<Output = Self>
    + Mul<Output = Self>
{
    /// The nearest one.
    fn of(value: f64) -> Self;

    fn to_f64(self) -> f64;
}

impl Real for f64 {
    #[inline(always)]
    fn of(value: f64) -> Self {
        value
    }

    #[inline(always)]
    fn to_f64(self) -> f64 {
        self
    }
}

impl Real for f32 {
    #[inline(always)]
    fn of(value: f64) -> Self {
        value as f32
    }

    #[inline(always)]
    fn to_f64(self) -> f64 {
        self.into()
    }
}

/// A value for each of the patches of a group.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Lanes<T>(pub(super) [T; LANES]);

impl<T: Real> Lanes<T> {
    /// The same value for all of them.
    #[inline(always)]
    pub(super) fn all(value: T) -> Self {
        Self([value; LANES])
    }

    /// In the other precision, each multiplied by a factor.
    #[inline(always)]
    pub(super) fn scaled<U: Real>(self, factor: f64) -> Lanes<U> {
        let mut scaled = [U::default(); LANES];
        for (scaled, value) in scaled.iter_mut().zip(self.0) {
            *scaled = U::of(factor * value.to_f64());
        }
        Lanes(scaled)
    }

    /// Zero where it is below.
    #[inline(always)]
    pub(super) fn positive(mut self) -> Self {
        for value in &mut self.0 {
            *value = if *value > T::default() { *value } else { T::default() };
        }
        self
    }
}

macro_rules! lane_by_lane {
    ($($operator:ident $function:ident),*) => {
        $(impl<T: Real> $operator for Lanes<T> {
            type Output = Self;

            #[inline(always)]
            fn $function(mut self, other: Self) -> Self {
                for (value, other) in self.0.iter_mut().zip(other.0) {
                    *value = value.$function(other);
                }
                self
            }
        })*
    };
}

lane_by_lane!(Add add, Sub sub, Mul mul);
