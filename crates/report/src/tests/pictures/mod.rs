//! Pictures: well-formed, bounded, described in words, and the same bytes for the same input.

mod samples;

use samples::{circle, current, glitches, list, states, value_list};

use crate::pictures::{AxisPlot, AxisSample, CurrentPlot, value_curve, value_curves};
use crate::svg::{
    ChartAxis, Drawn, Frame, LineChart, Panel, PolarChart, PolarPanel, PolarSeries, PolarStroke,
    Series,
};
use frictcomp::comp::State;
use frictcomp::lists::AxisType;
use frictcomp::machine::AcceptedList;
use frictcomp_physics::current::{AdditiveCurrent, Reading};
use frictcomp_testing::svg::{SVG, read, sound, texts};

fn all() -> Vec<(&'static str, String)> {
    vec![
        ("value-list", value_list().render(Frame::Alone)),
        ("current", current().render(Frame::Alone)),
        ("circle", circle().render(Frame::Alone)),
        ("tuning", glitches().render(Frame::Alone)),
        ("states", states().render(Frame::Alone)),
    ]
}

#[test]
fn every_picture_is_told_in_words() {
    for (name, svg) in all() {
        let document = read(&svg);
        let root = document.root_element();
        for (reference, element) in [("aria-labelledby", "title"), ("aria-describedby", "desc")] {
            let id = root.attribute(reference).expect("a reference");
            let told = document
                .descendants()
                .find(|node| node.attribute("id") == Some(id));
            let told = told.expect("what is referred to");
            assert!(told.has_tag_name((SVG, element)), "{name}");
            assert!(
                told.text().is_some_and(|text| text.len() > 10),
                "{name} has no {element}"
            );
        }
        assert!(
            svg.contains("prefers-color-scheme: dark"),
            "{name} has one ground only"
        );
        assert!(svg.contains("@media print"), "{name}");
    }
}

#[test]
fn the_same_input_gives_the_same_picture() {
    // R9.16
    assert_eq!(all(), all());
}

#[test]
fn a_circle_shows_off_and_on_magnified() {
    // R5.23
    let svg = circle().render(Frame::Alone);
    let document = read(&svg);
    let texts = texts(&document);
    for wanted in [
        "X+",
        "Y+",
        "X\u{2212}",
        "Y\u{2212}",
        "10 \u{b5}m",
        "+20 \u{b5}m",
        "+0.6 \u{b5}m",
        "compensation off",
        "compensation on",
    ] {
        assert!(texts.contains(&wanted), "no `{wanted}` in {texts:?}");
    }
    let magnified = texts
        .iter()
        .find(|text| text.starts_with("deviation magnified"));
    // 10 µm are 44 units where 100 mm are 145.
    assert_eq!(
        magnified.copied(),
        Some("deviation magnified 3000\u{d7} against the circle of 100 mm")
    );
    let paths: Vec<_> = document
        .descendants()
        .filter(|node| node.has_tag_name((SVG, "path")))
        .collect();
    assert_eq!(paths.len(), 2, "one in the circle, one in the inset");
    let circles = [
        ((281.0, 379.0), 56.5..=233.5),
        ((696.0, 262.0), 31.5..=116.5),
    ];
    for (path, (centre, rings)) in paths.into_iter().zip(circles) {
        let data = path.attribute("d").expect("data").replace(['M', 'L'], " ");
        let numbers: Vec<f64> = data
            .split_whitespace()
            .map(|number| number.parse().expect("a number"))
            .collect();
        for place in numbers.chunks(2) {
            let radius = (place[0] - centre.0).hypot(place[1] - centre.1);
            assert!(rings.contains(&radius), "{place:?} is outside of the rings");
        }
    }
}

#[test]
fn a_value_list_shows_its_points_and_held_ends() {
    // R4.7
    let svg = value_list().render(Frame::Alone);
    let document = read(&svg);
    let with = |class: &str| {
        let nodes = document.descendants();
        let count = nodes.filter(|node| {
            let classes = node.attribute("class").unwrap_or_default();
            classes.split(' ').any(|it| it == class)
        });
        count.count()
    };
    assert_eq!(with("fc-m2"), 5, "five points");
    assert_eq!(with("fc-m3"), 5, "the scaled points, of another shape");
    assert_eq!(with("fc-held"), 2);
    let texts = texts(&document);
    for text in [
        "scaled by 90 %",
        // Velocities also as feeds, from 0 to beyond the last point; values from 0 on.
        "velocity in \u{b5}m/s, logarithmic from 1800 on",
        "velocity in mm/min",
        "1800",
        "108",
        "2000",
        "0",
        "held above 50\u{202f}000",
    ] {
        assert!(texts.contains(&text), "{text}: {texts:?}");
    }
    // A tenth of the axis separates the slow points from each other.
    let places: Vec<f64> = document
        .descendants()
        .filter(|node| node.attribute("class") == Some("fc-m2"))
        .map(|node| node.attribute("cx").unwrap().parse().unwrap())
        .collect();
    assert!(places[2] - places[0] > 200.0, "{places:?}");
}

#[test]
fn a_list_without_a_point_at_standstill_says_what_is_held() {
    // R4.7
    let mut list = list();
    list.table.remove(0);
    let svg = value_curve(&AcceptedList {
        axis: "C".to_owned(),
        axis_type: AxisType::Rotary,
        list,
    })
    .render(Frame::Alone);
    let document = read(&svg);
    let texts = texts(&document);
    for text in [
        "held below 1800",
        "held above 50\u{202f}000",
        "velocity in \u{b0}/min",
    ] {
        assert!(texts.contains(&text), "{text}: {texts:?}");
    }
}

#[test]
fn value_lists_of_several_axes_share_a_picture() {
    let accepted = |axis: &str, axis_type| AcceptedList {
        axis: axis.to_owned(),
        axis_type,
        list: list(),
    };
    let lists = [
        accepted("X", AxisType::Linear),
        accepted("C", AxisType::Rotary),
    ];
    let svg = value_curves(&lists.iter().collect::<Vec<_>>()).render(Frame::Alone);
    let document = read(&svg);
    let texts = texts(&document);
    assert!(
        texts.contains(&"velocity in \u{b5}m/s or 0.001\u{b0}/s, logarithmic from 1800 on"),
        "{texts:?}"
    );
    assert!(texts.iter().any(|text| text.starts_with("axis C: ")));
}

#[test]
fn currents_are_steps_and_blocks_stand_along_the_time() {
    // R4.2 R4.3
    let chart = current();
    assert_eq!(chart.panels.len(), 4);
    let drawn: Vec<Drawn> = (chart.panels.iter())
        .map(|panel| panel.series[0].drawn)
        .collect();
    let (steps, weight) = (Drawn::Steps, Drawn::Notches);
    assert_eq!(drawn, [steps, Drawn::Line, weight, weight]);
    let svg = chart.render(Frame::Alone);
    let document = read(&svg);
    let seen = texts(&document);
    for text in ["N10", "line 3", "time in s, and where blocks begin"] {
        assert!(seen.contains(&text), "{text}: {seen:?}");
    }
    // A step is drawn level, then upright.
    let line = document
        .descendants()
        .find(|node| node.attribute("class") == Some("fc-curve fc-s2 fc-steps"));
    let path = line.and_then(|node| node.attribute("d")).unwrap();
    let places: Vec<(&str, &str)> = path
        .split(['M', 'L'])
        .filter_map(|place| place.split_once(' '))
        .collect();
    assert!(
        places
            .windows(2)
            .all(|pair| pair[0].0 == pair[1].0 || pair[0].1 == pair[1].1)
    );
    assert_eq!(
        document
            .descendants()
            .filter(|node| node.attribute("class") == Some("fc-f2"))
            .count(),
        2
    );
    // More blocks than there is room for are thinned out.
    let mut plot = CurrentPlot::new(vec![AxisPlot::new("X", None)]);
    for block in 0..100_000_u32 {
        plot.block(f64::from(block), Some(i64::from(block)), 1);
    }
    let marks = plot.chart().marks;
    assert!(marks.len() <= 2000, "{}", marks.len());
    assert!(marks.is_sorted_by(|one, other| one.at < other.at));
    assert!(marks.last().unwrap().at > 99_000.0);
}

#[test]
fn many_blocks_have_ticks_where_they_have_names() {
    let svg_of = |blocks: u32| {
        let mut plot = CurrentPlot::new(vec![AxisPlot::new("X", None)]);
        let cycles = AdditiveCurrent::new(&list(), Reading::default()).trace(&[0.0], &[0.0]);
        for block in 0..blocks {
            plot.block(f64::from(block), Some(i64::from(block)), 1);
            let sample = AxisSample {
                velocity: 0.0,
                state: State::Active,
                added: &cycles[0],
            };
            plot.push(f64::from(block), [sample]);
        }
        plot.chart().render(Frame::Alone)
    };
    // Ticks of blocks and of seconds, and names of blocks.
    let counted = |blocks| {
        let svg = svg_of(blocks);
        let ticks = svg.matches("fc-axis").count();
        (ticks, svg.matches(">N").count())
    };
    let ((few_ticks, few_names), (many_ticks, many_names)) = (counted(100), counted(600));
    assert!(few_ticks > 100 && few_names < 40, "{few_ticks} {few_names}");
    assert!(many_ticks < 60, "{many_ticks} ticks of {many_names} names");
    assert!(many_names > 10, "{many_names}");
}

#[test]
fn glitches_are_drawn_from_zero() {
    // R5.25
    let mut chart = glitches();
    for point in (chart.panels.iter_mut())
        .flat_map(|panel| &mut panel.series)
        .flat_map(|series| &mut series.points)
    {
        // As large as those of a soft plant, and as similar.
        point[1] += 100.0;
    }
    let svg = chart.render(Frame::Alone);
    let document = read(&svg);
    let zeros = texts(&document).into_iter().filter(|text| *text == "0");
    assert_eq!(zeros.count(), chart.panels.len());
}

#[test]
fn points_without_a_line_have_none_in_the_legend() {
    // R6.18
    let series = |name: &str, drawn| Series {
        name: name.to_owned(),
        points: vec![[0.0, 1.0], [1.0, 2.0]],
        drawn,
    };
    let chart = LineChart {
        panels: vec![Panel {
            series: vec![
                series("measured", Drawn::Scattered),
                series("curve", Drawn::Line),
            ],
            ..Panel::default()
        }],
        ..LineChart::default()
    };
    let svg = chart.render(Frame::Alone);
    let document = read(&svg);
    assert!(texts(&document).contains(&"measured"));
    let lines = |class: &str| {
        let nodes = document.descendants();
        nodes
            .filter(|node| node.attribute("class") == Some(class))
            .count()
    };
    assert_eq!([lines("fc-curve fc-s2"), lines("fc-curve fc-s3")], [0, 2]);
}

#[test]
fn a_million_cycles_are_a_picture_of_bounded_size() {
    let points = (0..1_000_000_u32).map(|at| [f64::from(at), f64::from(at % 977)]);
    let chart = LineChart {
        title: "long".to_owned(),
        description: "A million cycles.".to_owned(),
        x: ChartAxis::linear("time in s"),
        panels: vec![Panel {
            y: ChartAxis::linear("value"),
            series: vec![Series {
                name: "value".to_owned(),
                points: points.collect(),
                drawn: Drawn::Line,
            }],
            ..Panel::default()
        }],
        ..LineChart::default()
    };
    let svg = chart.render(Frame::Alone);
    assert!(svg.len() < 100_000, "{} bytes", svg.len());
    // The peaks are still there: the curve reaches the tick above 976.
    assert!(texts(&read(&svg)).contains(&"1000"));
}

#[test]
fn changes_that_cannot_be_seen_are_one_bar() {
    let svg = states().render(Frame::Inside("here"));
    let document = read(&svg);
    let titles: Vec<_> = document
        .descendants()
        .filter(|node| node.has_tag_name("title"))
        .filter_map(|node| node.text())
        .collect();
    let several = titles
        .iter()
        .filter(|title| title.contains("several short changes"));
    assert_eq!(several.count(), 1);
    assert!(titles.contains(&"from 40 to 80: unknown"));
    assert!(!svg.contains("<style>"), "the page has the style");
    assert!(svg.contains("id=\"here-title\""));
}

#[test]
fn odd_values_make_no_odd_picture() {
    let odd = [
        f64::NAN,
        f64::INFINITY,
        f64::NEG_INFINITY,
        f64::MAX,
        f64::MIN,
        f64::MIN_POSITIVE,
        0.0,
        -0.0,
    ];
    let points: Vec<[f64; 2]> = odd.iter().flat_map(|&x| odd.map(|y| [x, y])).collect();
    for points in [points, Vec::new(), vec![[3.0, 3.0]]] {
        for x in [ChartAxis::linear("<x> & \0"), ChartAxis::logarithmic("]]>")] {
            let chart = LineChart {
                title: "<script>alert(1)</script>\0\u{202e}\u{ffff}".to_owned(),
                description: "--> \u{b} \" '".to_owned(),
                x,
                panels: vec![Panel {
                    y: ChartAxis::linear("y"),
                    series: vec![Series {
                        name: "</svg>".to_owned(),
                        points: points.clone(),
                        drawn: Drawn::Marked,
                    }],
                    ..Panel::default()
                }],
                ..LineChart::default()
            };
            sound(&chart.render(Frame::Alone));
        }
        let polar = PolarChart {
            panels: vec![PolarPanel {
                label: "&".to_owned(),
                series: vec![PolarSeries {
                    look: 0,
                    stroke: PolarStroke::Full,
                    name: "&".to_owned(),
                    points: points.clone(),
                }],
            }],
            ..circle()
        };
        sound(&polar.render(Frame::Alone));
    }
}
