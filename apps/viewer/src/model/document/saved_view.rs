//! Views with names.

use serde::{Deserialize, Serialize};

use crate::model::view::View;

/// A view that was saved under a name, to come back to.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SavedView {
    /// Its name.
    #[serde(default)]
    pub name: String,
    /// The view.
    #[serde(flatten)]
    pub view: View,
}

impl SavedView {
    /// A view with the first name of the form "View 1" that none of the others has.
    pub fn new(view: View, others: &[Self]) -> Self {
        let names = (1..).map(|number| format!("View {number}"));
        let taken = |name: &String| others.iter().any(|other| other.name == *name);
        let mut free = names.filter(|name| !taken(name));
        Self {
            name: free.next().unwrap_or_default(),
            view,
        }
    }
}
