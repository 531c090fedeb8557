//! A datum over the domain: one function, values over a mesh, or one of these for each named region.

use std::sync::Arc;

use super::Function;

/// A tension, a load, a foundation, a height, or an obstacle, as a datum over the domain.
///
/// ```
/// use membrane_contact::problem::Field;
///
/// let stiff = Field::by_region([("rubber", 1.0), ("steel", 40.0)]).elsewhere(2.0);
/// assert_eq!(stiff.names().collect::<Vec<_>>(), ["rubber", "steel"]);
/// ```
#[derive(Debug, Clone)]
#[non_exhaustive]
pub enum Field {
    /// The same function everywhere.
    Everywhere(Function),
    /// The values at the vertices of the mesh, affine between them.
    PerVertex(Arc<[f64]>),
    /// One value for each triangle of the mesh.
    PerTriangle(Arc<[f64]>),
    /// The data view of this name that the mesh has, at its vertices or on its triangles.
    View(String),
    /// Another field in each named region.
    ByRegion {
        /// The regions that have their own, and that.
        parts: Vec<(String, Field)>,
        /// The field outside of them; `None` when they have to cover the domain.
        elsewhere: Option<Box<Field>>,
    },
}

impl Field {
    /// One field for each named region, which together cover the domain; else add [`elsewhere`](Self::elsewhere).
    pub fn by_region<N: Into<String>, F: Into<Self>>(parts: impl IntoIterator<Item = (N, F)>) -> Self {
        let parts = parts.into_iter().map(|(name, field)| (name.into(), field.into())).collect();
        Self::ByRegion { parts, elsewhere: None }
    }

    /// The same with this field outside of the named regions; without regions, this field.
    pub fn elsewhere(self, field: impl Into<Self>) -> Self {
        match self {
            Self::ByRegion { parts, .. } => Self::ByRegion { parts, elsewhere: Some(Box::new(field.into())) },
            _ => field.into(),
        }
    }

    /// The names of the regions that it asks for.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        let parts = match self {
            Self::ByRegion { parts, .. } => parts.as_slice(),
            _ => &[],
        };
        parts.iter().map(|(name, _)| name.as_str())
    }

    /// The data view of this name, for example one of the mesh file: `$NodeData` at vertices, `$ElementData` on triangles. It is looked up
    /// when the problem is posed on a mesh, and follows its refinements.
    pub fn view(name: impl Into<String>) -> Self {
        Self::View(name.into())
    }

    /// The names of the data views that it asks for.
    pub fn views(&self) -> Vec<&str> {
        match self {
            Self::View(name) => vec![name],
            Self::ByRegion { parts, elsewhere } => {
                let fields = parts.iter().map(|(_, field)| field).chain(elsewhere.as_deref());
                fields.flat_map(Self::views).collect()
            }
            _ => Vec::new(),
        }
    }

    /// The number, where it is the same everywhere and known without a mesh.
    pub fn constant(&self) -> Option<f64> {
        match self {
            Self::Everywhere(Function::Constant(value)) => Some(*value),
            _ => None,
        }
    }

    /// The function, where one serves everywhere.
    pub(super) fn function(&self) -> Option<&Function> {
        match self {
            Self::Everywhere(function) => Some(function),
            _ => None,
        }
    }

    /// The numbers that it consists of, as far as they are known without a mesh.
    pub(super) fn numbers(&self) -> Vec<f64> {
        match self {
            Self::Everywhere(Function::Constant(value)) => vec![*value],
            Self::Everywhere(_) | Self::View(_) => Vec::new(),
            Self::PerVertex(values) | Self::PerTriangle(values) => values.to_vec(),
            Self::ByRegion { parts, elsewhere } => parts
                .iter()
                .map(|(_, field)| field)
                .chain(elsewhere.as_deref())
                .flat_map(Self::numbers)
                .collect(),
        }
    }
}

impl<F: Into<Function>> From<F> for Field {
    fn from(function: F) -> Self {
        Self::Everywhere(function.into())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_field_knows_its_names_and_numbers() {
        let field = Field::by_region([("a", Field::from(2.0)), ("b", Field::PerTriangle([3.0, 4.0].into()))]);
        assert_eq!(
            (field.names().collect::<Vec<_>>(), field.numbers()),
            (vec!["a", "b"], vec![2.0, 3.0, 4.0])
        );
        let field = field.elsewhere(5.0);
        assert_eq!((field.numbers().last(), field.constant()), (Some(&5.0), None));
        let views =
            Field::by_region([("a", Field::view("p")), ("b", 1.0.into())]).elsewhere(Field::view("q"));
        assert_eq!((views.views(), views.numbers(), views.constant()), (vec!["p", "q"], vec![1.0], None));
        let everywhere = Field::from("x + 1".parse::<crate::problem::Expression>().unwrap());
        assert!(everywhere.names().next().is_none() && everywhere.numbers().is_empty());
        assert!(everywhere.function().is_some() && field.function().is_none());
        assert_eq!(Field::PerVertex([1.0].into()).elsewhere(3.0).constant(), Some(3.0));
    }
}
