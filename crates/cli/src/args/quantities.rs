//! Numbers of options with their units: `10um`, `0.01mm`. A number alone has the unit that the help of the option names.

/// A unit: its word, and the factor to the unit of a number alone as a fraction, so that decimal numbers stay exact.
type UnitScale = (&'static str, f64, f64);

const MM: UnitScale = ("mm", 1.0, 1.0);
const UM_OF_MM: [UnitScale; 2] = [("um", 1.0, 1000.0), ("µm", 1.0, 1000.0)];
const DEGREES: [UnitScale; 2] = [("deg", 1.0, 1.0), ("°", 1.0, 1.0)];

/// Parses a length in mm.
pub(crate) fn mm(text: &str) -> Result<f64, String> {
    parse(text, &[&[MM], &UM_OF_MM])
}

/// Parses a position or distance of an axis in mm or degrees.
pub(crate) fn mm_or_degrees(text: &str) -> Result<f64, String> {
    parse(text, &[&[MM], &UM_OF_MM, &DEGREES])
}

/// Parses a part in per cent.
pub(crate) fn percent(text: &str) -> Result<f64, String> {
    parse(text, &[&[("%", 1.0, 1.0)]])
}

/// Parses a deviation in µm.
pub(crate) fn um(text: &str) -> Result<f64, String> {
    parse(
        text,
        &[&[("um", 1.0, 1.0), ("µm", 1.0, 1.0), ("mm", 1000.0, 1.0)]],
    )
}

/// Parses a feed in mm/min.
pub(crate) fn mm_per_min(text: &str) -> Result<f64, String> {
    parse(text, &[&FEEDS])
}

const FEEDS: [UnitScale; 3] = [
    ("mm/min", 1.0, 1.0),
    ("m/min", 1000.0, 1.0),
    ("mm/s", 60.0, 1.0),
];

/// Parses a feed of an axis in mm/min or °/min.
pub(crate) fn feed_of_axis(text: &str) -> Result<f64, String> {
    parse(
        text,
        &[&FEEDS, &[("deg/min", 1.0, 1.0), ("°/min", 1.0, 1.0)]],
    )
}

/// Parses a speed of an axis in mm/s or °/s.
pub(crate) fn speed_of_axis(text: &str) -> Result<f64, String> {
    let turning = [("deg/s", 1.0, 1.0), ("°/s", 1.0, 1.0)];
    parse(
        text,
        &[
            &[
                ("mm/s", 1.0, 1.0),
                ("mm/min", 1.0, 60.0),
                ("um/s", 1.0, 1000.0),
            ],
            &turning,
        ],
    )
}

/// Parses a velocity in µm/s or 0.001°/s.
pub(crate) fn um_per_s(text: &str) -> Result<f64, String> {
    let turning = [("deg/s", 1000.0, 1.0), ("°/s", 1000.0, 1.0)];
    let straight = [
        ("um/s", 1.0, 1.0),
        ("µm/s", 1.0, 1.0),
        ("mm/s", 1000.0, 1.0),
        ("mm/min", 1000.0, 60.0),
    ];
    parse(text, &[&straight, &turning])
}

/// Parses an acceleration in mm/s².
pub(crate) fn mm_per_s2(text: &str) -> Result<f64, String> {
    parse(
        text,
        &[&[
            ("mm/s2", 1.0, 1.0),
            ("mm/s²", 1.0, 1.0),
            ("m/s2", 1000.0, 1.0),
            ("m/s²", 1000.0, 1.0),
        ]],
    )
}

/// Parses a time in ms.
pub(crate) fn ms(text: &str) -> Result<f64, String> {
    parse(
        text,
        &[&[
            ("ms", 1.0, 1.0),
            ("us", 1.0, 1000.0),
            ("µs", 1.0, 1000.0),
            ("s", 1000.0, 1.0),
        ]],
    )
}

fn parse(text: &str, units: &[&[UnitScale]]) -> Result<f64, String> {
    let text = text.trim().to_lowercase();
    let units = units.concat();
    let (alone, times, per) = units[0];
    let others: Vec<&str> = units[1..].iter().map(|it| it.0).collect();
    let all = [("", times, per)].into_iter().chain(units);
    let mut values = all.filter_map(|(word, times, per)| {
        let number: f64 = text.strip_suffix(word)?.trim_end().parse().ok()?;
        Some(number * times / per)
    });
    let value = values.find(|value| value.is_finite());
    value.ok_or_else(|| {
        let others = match &*others.join(", ") {
            "" => String::new(),
            others => format!(", or with one of the units {others}"),
        };
        format!("write a number in {alone}{others}")
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_has_its_unit_or_that_of_the_help() {
        // R9.78
        for text in ["0.01", "0.01mm", "10um", "10 µm", " +0.01 MM ", "1e-2"] {
            assert_eq!(mm(text), Ok(0.01), "{text}");
        }
        assert_eq!(um("0.0005mm"), Ok(0.5));
        assert_eq!(mm_per_min("2m/min"), Ok(2000.0));
        assert_eq!(mm_per_min("-50mm/s"), Ok(-3000.0));
        assert_eq!(feed_of_axis("720°/min"), Ok(720.0));
        assert_eq!(speed_of_axis("12mm/min"), Ok(0.2));
        assert_eq!(um_per_s("1deg/s"), Ok(1000.0));
        assert_eq!(ms("0.002s"), Ok(2.0));
        assert_eq!(mm_per_s2("0.07 m/s²"), Ok(70.0));
        assert_eq!(mm_or_degrees("90°"), Ok(90.0));
        for text in ["", "mm", "1kg", "1mm/min", "1..2", "nan", "inf", "1e999"] {
            let said = "write a number in mm, or with one of the units um, µm";
            assert_eq!(mm(text), Err(said.to_owned()), "{text}");
        }
    }
}
