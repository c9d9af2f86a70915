//! Recorded circles: CSV files of actual positions.

use std::path::{Path, PathBuf};

use super::failure::Failure;
use super::files::open_regular;
use crate::circle::{RecordedCircle, RecordedError, Recording};
use crate::diagnostic::Shown;

/// Rows of a file at most; they are kept in memory until the circle is evaluated.
const MAX_ROWS: usize = 4_000_000;

/// A column of positions and what makes millimetres of its numbers.
struct Column {
    name: String,
    at: usize,
    millimetres: f64,
}

/// One or two recorded circles.
pub(super) fn read(paths: &[PathBuf], radius: Option<f64>) -> Result<Recording, Failure> {
    if paths.len() > 2 {
        let message = format!("{} recordings were given", paths.len());
        return Err(Failure::new(message).with_help("give one of each direction, two at most"));
    }
    if let Some(radius) = radius
        && !(0.001..=1e6).contains(&radius)
    {
        let message = format!(
            "a radius of {} mm is not possible, it must be between 0.001 and 1000000 mm",
            Shown(radius)
        );
        return Err(Failure::new(message).with_help("write the commanded radius, `--radius 100`"));
    }
    let circle = |path: &PathBuf| {
        let points = points(path)?;
        RecordedCircle::new(&points, radius).map_err(|error| refused(path, &error))
    };
    let circles = paths.iter().map(circle).collect::<Result<Vec<_>, _>>()?;
    Recording::new(circles, radius)
        .map_err(|error| Failure::new(error.to_string()).with_help(error.help()))
}

fn refused(path: &Path, error: &RecordedError) -> Failure {
    Failure::new(format!("`{}`: {error}", path.display())).with_help(error.help())
}

/// The actual positions in mm, in the order of the rows.
fn points(path: &Path) -> Result<Vec<[f64; 2]>, Failure> {
    let (file, _) = open_regular(path).map_err(|error| Failure::reading(path, &error))?;
    let damaged = |error: &csv::Error| {
        Failure::new(format!(
            "the recording `{}` cannot be read: {error}",
            path.display()
        ))
        .with_help("a recording is a CSV file with a header, UTF-8, decimal points")
    };
    let mut reader = csv::ReaderBuilder::new()
        .trim(csv::Trim::All)
        .from_reader(file);
    let headers = reader.headers().map_err(|error| damaged(&error))?.clone();
    let [x, y] = [column(&headers, "x"), column(&headers, "y")];
    let (Some(x), Some(y)) = (x, y) else {
        let found: Vec<&str> = headers.iter().collect();
        return Err(Failure::new(format!(
            "the recording `{}` has no columns `x` and `y`, only {}",
            path.display(),
            found.join(", ")
        ))
        .with_help("name the columns `x` and `y` for mm, or `x_um` and `y_um` for µm"));
    };
    let mut points = Vec::new();
    for record in reader.records() {
        let record = record.map_err(|error| damaged(&error))?;
        if points.len() == MAX_ROWS {
            let message = format!("`{}` has more than {MAX_ROWS} rows", path.display());
            return Err(Failure::new(message).with_help("record with a lower rate"));
        }
        let line = record.position().map_or(0, csv::Position::line);
        let number = |column: &Column| {
            let text = record.get(column.at).unwrap_or_default();
            let number = text.parse::<f64>().ok().filter(|number| number.is_finite());
            number
                .map(|number| number * column.millimetres)
                .ok_or_else(|| {
                    Failure::new(format!(
                        "{}:{line}: column `{}` holds `{text}`, which is not a number",
                        path.display(),
                        column.name
                    ))
                    .with_help("write numbers with a decimal point")
                })
        };
        points.push([number(&x)?, number(&y)?]);
    }
    Ok(points)
}

/// The column of an axis: its name alone for mm, or with a unit, `x_um`, `X [mm]`.
fn column(headers: &csv::StringRecord, axis: &str) -> Option<Column> {
    headers.iter().enumerate().find_map(|(at, name)| {
        let words: Vec<String> = name
            .split(|letter: char| !letter.is_alphanumeric())
            .filter(|word| !word.is_empty())
            .map(str::to_lowercase)
            .collect();
        let words: Vec<&str> = words.iter().map(String::as_str).collect();
        let millimetres = match words[..] {
            [first] if first == axis => 1.0,
            [first, "mm"] if first == axis => 1.0,
            // The Greek letter; the micro sign becomes it in lower case or stays.
            [first, "um" | "\u{b5}m" | "\u{3bc}m"] if first == axis => 0.001,
            [first, "m"] if first == axis => 1000.0,
            _ => return None,
        };
        Some(Column {
            name: name.to_owned(),
            at,
            millimetres,
        })
    })
}
