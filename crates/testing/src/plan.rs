//! The call that plans measuring programs.

/// Returns the arguments that plan circles of X and Y about X50 Y0 at feeds, on a radius of at most 45 mm; the folder
/// follows.
pub const fn planned_circles(feeds: &'static str, radius: &'static str) -> [&'static str; 13] {
    [
        "commission",
        "plan",
        "--axis",
        "X,Y",
        "--travel",
        "X0..100,Y-50..50",
        "--feeds",
        feeds,
        "--radius",
        radius,
        "--slowest",
        "0.5",
        "--into",
    ]
}
