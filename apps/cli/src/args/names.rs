//! Words on the command line.

use clap::ValueEnum;

/// How progress is shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum ProgressMode {
    /// A bar on a terminal, lines elsewhere.
    Auto,
    /// A line now and then.
    Plain,
    /// A line of JSON now and then.
    Json,
    /// Not at all.
    None,
}

/// How light is followed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum IntegratorName {
    /// Mirrors, glass, lights without a surface.
    Whitted,
    /// All light.
    Path,
    /// How open the surroundings are.
    Ao,
    /// How much work each pixel is.
    Cost,
}

/// How light becomes colours.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum CurveName {
    /// Cut off.
    None,
    /// By luminance.
    Reinhard,
    /// Film-like.
    Aces,
    /// Film-like, softer.
    Filmic,
}

/// How samples become pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum FilterName {
    /// The mean of the square.
    Box,
    /// A pyramid.
    Tent,
    /// A bell.
    Gaussian,
    /// Sharper.
    Mitchell,
}

/// What there is to choose from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum ListName {
    /// Of ordering objects.
    Techniques,
    /// Techniques in one another.
    Presets,
    /// Made by program.
    Scenes,
    /// That scenes are made of.
    Shapes,
}
