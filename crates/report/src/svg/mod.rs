//! Pictures as SVG, for a browser, a document or the HTML report.
//!
//! The module does not use a plotting crate: it draws lines, points, bands, one magnified circle and
//! one magnified path. The maintained crates (`plotters`, `poloto`) support neither dark backgrounds,
//! nor titles for screen readers, nor bands with links, nor a magnified polar deviation, so each of these
//! would have to be written on top of them.
//!
//! A chart is plain data with a method to [`render`](LineChart::render) it. Every picture has a
//! `<title>` and a `<desc>`, follows a dark background, distinguishes series by dash and marker as
//! well as by colours that colour-blind people can tell apart, and has a bounded size, however many
//! points it is given.

mod bands;
mod canvas;
mod frame;
mod legend;
mod line;
mod plane;
mod polar;
mod reduce;
mod scale;
mod shape;
mod ticks;

pub use bands::{Band, BandChart, BandRow};
pub(crate) use frame::COLOURS;
pub use frame::{Frame, style};
pub use line::{CurveLooks, CurveNote, Drawn, LineChart, Panel, PanelHeight, Series, XMark};
pub use plane::{PlaneChart, PlaneMark, PlanePoint, Stroke};
pub use polar::{PolarChart, PolarPanel, PolarSeries, PolarStroke};
pub use reduce::Curve;
pub(super) use scale::number;
pub use scale::{ChartAxis, SecondUnit, Spacing};
pub use shape::{BandState, StartUpRelation};
