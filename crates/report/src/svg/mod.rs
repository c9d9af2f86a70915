//! Pictures as SVG, for a browser, a document or the HTML report.
//!
//! A module of our own and not a plotting crate: what is drawn here are lines, points, bands and
//! one magnified circle, some six hundred lines. The kept crates (`plotters`, `poloto`) know
//! neither dark backgrounds, nor titles for screen readers, nor bands with links, nor a magnified
//! polar deviation, so each of these would have been written on top of them.
//!
//! A chart is plain data and is asked to [`render`](LineChart::render) itself. Every picture has a
//! `<title>` and a `<desc>`, follows a dark background, tells series apart by dash and marker as
//! well as by colours that colour-blind people distinguish, and has a bounded size, however many
//! points it is given.

mod bands;
mod canvas;
mod escape;
mod frame;
mod line;
mod plane;
mod polar;
mod reduce;
mod scale;

pub use bands::{Band, BandChart, BandRow, BandState, StartUpRelation};
pub use frame::{Frame, STYLE};
pub use line::{CurveNote, Drawn, LineChart, Panel, PanelHeight, Series, XMark};
pub use plane::{PlaneChart, PlaneMark, PlanePoint, Stroke};
pub use polar::{PolarChart, PolarPanel, PolarSeries, PolarStroke};
pub use reduce::Curve;
pub(super) use scale::number;
pub use scale::{ChartAxis, SecondUnit, Spacing};
