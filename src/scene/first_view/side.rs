//! The sides from which somebody may want to see a scene.

/// A side of a scene, as of a thing on a table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    /// +z, where +y is up.
    Front,
    /// -z.
    Back,
    /// -x: what is on the left as seen from the front.
    Left,
    /// +x.
    Right,
    /// From steeply above, the front below in the picture.
    Top,
}

impl Side {
    /// All of them.
    pub const ALL: [Side; 5] = [Side::Front, Side::Back, Side::Left, Side::Right, Side::Top];

    /// Its name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Side::Front => "front",
            Side::Back => "back",
            Side::Left => "left",
            Side::Right => "right",
            Side::Top => "top",
        }
    }
}
