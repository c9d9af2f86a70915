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
mod line;
mod polar;
mod reduce;
mod scale;

pub use bands::{Band, BandChart, BandRow, BandState, Standing};
pub use line::{Drawn, LineChart, Panel, Series};
pub use polar::{PolarChart, PolarSeries};
pub use reduce::Curve;
pub use scale::{Axis, Spacing};

/// Where a picture stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Frame<'a> {
    /// A file of its own, which carries its style.
    Alone,
    /// In a page that has [`STYLE`] in its own; the name makes the identifiers of the picture
    /// unique there.
    Inside(&'a str),
}

/// The style of all pictures. Nothing but class rules: what does not know `@media` draws them on
/// light ground.
pub const STYLE: &str = "\
.fc-picture{font:12px system-ui,-apple-system,'Segoe UI',Roboto,'Noto Sans',sans-serif}
.fc-picture text{fill:#24292f}
.fc-picture .fc-title{font-size:15px;font-weight:600}
.fc-picture .fc-quiet{fill:#57606a}
.fc-picture .fc-ground{fill:#fff}
.fc-picture .fc-grid{stroke:#e3e6ea;fill:none}
.fc-picture .fc-axis{stroke:#6e7781;fill:none}
.fc-picture .fc-s0{stroke:#0072b2}.fc-picture .fc-m0{fill:#0072b2}
.fc-picture .fc-s1{stroke:#d55e00;stroke-dasharray:8 3}.fc-picture .fc-m1{fill:#d55e00}
.fc-picture .fc-s2{stroke:#007a5a;stroke-dasharray:2 3}.fc-picture .fc-m2{fill:#007a5a}
.fc-picture .fc-s3{stroke:#a0467a;stroke-dasharray:10 3 2 3}.fc-picture .fc-m3{fill:#a0467a}
.fc-picture .fc-curve{fill:none;stroke-width:1.6;stroke-linejoin:round}
.fc-picture .fc-held{stroke-dasharray:4 4;stroke-width:1.2}
.fc-picture .fc-active{fill:#d6e8f5;stroke:#0072b2}
.fc-picture .fc-inactive{fill:#fff;stroke:#6e7781}
.fc-picture .fc-half{fill:#d55e00;stroke:none}
.fc-picture .fc-outline{fill:#fff;stroke:#d55e00}
.fc-picture .fc-absent{stroke:#8c959f;stroke-width:2}
.fc-picture .fc-unknown{fill:#fff6d6;stroke:#8a6400;stroke-dasharray:4 3}
.fc-picture .fc-mixed{fill:#cfe3f1;stroke:#0072b2;stroke-dasharray:2 2}
.fc-picture .fc-away{fill:#ffd9b8;stroke:#b34700;stroke-width:1.4}
.fc-picture .fc-stripes{stroke:#f3a161;stroke-width:16;stroke-dasharray:3 6}.fc-picture .fc-low{stroke-width:11}
.fc-picture text.fc-on-away{fill:#5f2500;font-weight:700;paint-order:stroke;stroke:#ffd9b8;stroke-width:4px;stroke-linejoin:round}
@media (max-width:40rem){.fc-picture{font-size:15px}.fc-picture .fc-title{font-size:17px}}
.fc-picture a:focus-visible{outline:2px solid #d55e00;outline-offset:1px}
@media (prefers-color-scheme:dark){
.fc-picture text{fill:#e6edf3}
.fc-picture .fc-quiet{fill:#9da7b3}
.fc-picture .fc-ground{fill:#14181d}
.fc-picture .fc-grid{stroke:#2d343c}
.fc-picture .fc-axis{stroke:#8b949e}
.fc-picture .fc-s0{stroke:#58b4f0}.fc-picture .fc-m0{fill:#58b4f0}
.fc-picture .fc-s1{stroke:#ff9248}.fc-picture .fc-m1{fill:#ff9248}
.fc-picture .fc-s2{stroke:#3ccf9e}.fc-picture .fc-m2{fill:#3ccf9e}
.fc-picture .fc-s3{stroke:#e59ac4}.fc-picture .fc-m3{fill:#e59ac4}
.fc-picture .fc-active{fill:#16344d;stroke:#58b4f0}
.fc-picture .fc-away{fill:#4d2608;stroke:#ff9248}
.fc-picture .fc-stripes{stroke:#8a4510}
.fc-picture text.fc-on-away{fill:#ffe0c7;stroke:#4d2608}
.fc-picture .fc-inactive{fill:#14181d;stroke:#8b949e}
.fc-picture .fc-half{fill:#ff9248}
.fc-picture .fc-outline{fill:#14181d;stroke:#ff9248}
.fc-picture .fc-unknown{fill:#3a3010;stroke:#e0b23c}
.fc-picture .fc-mixed{fill:#1b3b57;stroke:#58b4f0}
}
@media print{
.fc-picture text{fill:#000}
.fc-picture .fc-quiet{fill:#444}
.fc-picture .fc-ground{fill:#fff}
.fc-picture .fc-grid{stroke:#ddd}
.fc-picture .fc-axis{stroke:#555}
.fc-picture .fc-s0{stroke:#0072b2}.fc-picture .fc-m0{fill:#0072b2}
.fc-picture .fc-s1{stroke:#d55e00}.fc-picture .fc-m1{fill:#d55e00}
.fc-picture .fc-s2{stroke:#007a5a}.fc-picture .fc-m2{fill:#007a5a}
.fc-picture .fc-s3{stroke:#a0467a}.fc-picture .fc-m3{fill:#a0467a}
.fc-picture .fc-active{fill:#d6e8f5;stroke:#0072b2}
.fc-picture .fc-away{fill:#ffd9b8;stroke:#b34700}
.fc-picture .fc-stripes{stroke:#f3a161}
.fc-picture text.fc-on-away{fill:#5f2500;stroke:#ffd9b8}
.fc-picture .fc-inactive{fill:#fff;stroke:#555}
.fc-picture .fc-half{fill:#d55e00}
.fc-picture .fc-outline{fill:#fff;stroke:#d55e00}
.fc-picture .fc-unknown{fill:#fff6d6;stroke:#8a6400}
.fc-picture .fc-mixed{fill:#cfe3f1;stroke:#0072b2}
}
";
