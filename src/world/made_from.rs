//! What the parts of a step in progress were made from: the one key that says what is up to date.

/// Revisions of what things were made from; what was made from none is to be made.
#[derive(Clone, Copy, Debug)]
pub(super) struct MadeFrom {
    /// Of the bodies last looked over: their changes and their removals.
    pub(super) bodies: Option<(u64, u64)>,
    /// Of the joints last looked over.
    pub(super) joints: u64,
    /// Of the forces on bodies last looked at.
    pub(super) pushes: u64,
    /// The list of pairs that the narrow phase has.
    list: Option<u64>,
    /// Who was awake when runs were last laid out, and when pairs were last sorted by it.
    awake: u64,
    sorted: Option<u64>,
    /// Poses are those that the last step left: manifolds may be reused.
    own_poses: bool,
}

impl Default for MadeFrom {
    fn default() -> Self {
        // Nobody sleeps, and there are no pairs to sort.
        Self { bodies: None, joints: 0, pushes: 0, list: None, awake: 0, sorted: Some(0), own_poses: false }
    }
}

impl MadeFrom {
    /// Poses may have changed by other hands than a step's: no manifold may be reused.
    pub(super) fn forget_poses(&mut self) {
        self.own_poses = false;
    }

    /// Have poses changed by a step alone? From now on, until they are forgotten.
    pub(super) fn poses_are_its_own(&mut self) -> bool {
        std::mem::replace(&mut self.own_poses, true)
    }

    /// Takes the list of pairs with this number; says whether it is another than before.
    pub(super) fn take_list(&mut self, list: u64) -> bool {
        self.list.replace(list) != Some(list)
    }

    /// Takes who is awake, by how often that has changed; says whether it has since the last time.
    pub(super) fn take_awake(&mut self, changes: u64) -> bool {
        std::mem::replace(&mut self.awake, changes) != changes
    }

    /// How often who is awake had changed when runs were laid out.
    pub(super) fn awake(&self) -> u64 {
        self.awake
    }

    /// Are pairs sorted by who is awake?
    pub(super) fn is_sorted(&self) -> bool {
        self.sorted == Some(self.awake)
    }

    /// Pairs will be sorted by who is awake now; says whether they were by others.
    pub(super) fn take_sorted(&mut self) -> bool {
        self.sorted.replace(self.awake) != Some(self.awake)
    }

    /// Pairs are to be sorted once more.
    pub(super) fn sort_again(&mut self) {
        self.sorted = None;
    }
}
