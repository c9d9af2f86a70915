//! Objections of the recorded feeds of a round to its lists (R16.9, R16.12, R16.15).

use frictcomp_physics::circle::GlitchOrder;

use super::compared::{BeforeAfter, PlaceCompared};

/// A round of lists, recorded off and on.
#[derive(Debug, Clone, Copy)]
pub(super) struct JudgedRound<'a> {
    /// The planned feeds.
    pub feeds: &'a [f64],
    /// The recorded ones.
    pub recorded: &'a [BeforeAfter],
    /// The round that was accepted last, with its number.
    pub accepted: Option<(usize, &'a [BeforeAfter])>,
    /// The unit of the glitches.
    pub unit: &'a str,
}

/// Reasons against the lists of a round, each axis, direction and feed for itself: more is left than without them or
/// than with those accepted last, a feed is not recorded, or nothing shows that they were on.
pub(super) fn feeds_against(round: &JudgedRound<'_>) -> Vec<String> {
    let mut against = Vec::new();
    let at = |recorded: &'_ [BeforeAfter], feed: f64| {
        let mut recorded = recorded.iter();
        recorded.position(|it| it.feed.total_cmp(&feed).is_eq())
    };
    for &feed in round.feeds {
        let Some(now) = at(round.recorded, feed).map(|it| &round.recorded[it]) else {
            against.push(format!("F{feed} is not recorded both off and on"));
            continue;
        };
        let before = round
            .accepted
            .and_then(|(number, recorded)| Some((number, &recorded[at(recorded, feed)?])));
        if let (Some((number, _)), None) = (round.accepted, before) {
            against.push(format!(
                "F{feed} was not recorded with the lists of round {number}, which may leave less"
            ));
        }
        for place in &now.places {
            let off = worse(round, feed, (place, &place.off), "without it");
            let earlier = before.and_then(|(number, before)| {
                let words = format!("of round {number}");
                worse(round, feed, (place, &before.at(place)?.on), &words)
            });
            against.extend(off.or(earlier));
        }
    }
    let mut axes: Vec<&str> = Vec::new();
    for place in round.recorded.iter().flat_map(|it| &it.places) {
        if !axes.contains(&place.axis.as_str()) {
            axes.push(&place.axis);
        }
    }
    for axis in axes {
        let mut places = round.recorded.iter().flat_map(|it| it.of_axis(axis));
        if !round.recorded.is_empty() && places.all(PlaceCompared::leaves_only_noise) {
            against.push(format!(
                "at no reversal more than noise is left of {axis}, at any feed: its positions are commanded or averaged \
                 ones; record the actual ones"
            ));
        }
        let is_seen = |it: &BeforeAfter| it.of_axis(axis).any(PlaceCompared::shows_an_effect);
        if round.recorded.iter().any(is_seen) {
            against.extend(without_effect(round.recorded, axis).into_iter().map(|feed| {
                format!(
                    "at F{feed} off and on hardly differ on {axis}, and at the next feeds they do: compensation was the \
                     same in both"
                )
            }));
        } else if !round.recorded.is_empty() {
            against.push(format!(
                "off and on hardly differ on {axis} at any feed: its list was not on, or on in both"
            ));
        }
    }
    against
}

/// States that a list leaves more at a place than before, if so, or that the turns differ too much to exclude it.
fn worse(
    round: &JudgedRound<'_>,
    feed: f64,
    (now, before): (&PlaceCompared, &frictcomp_physics::circle::MeasuredGlitch),
    than: &str,
) -> Option<String> {
    let unit = round.unit;
    match now.on.compared_with(before) {
        GlitchOrder::Larger => Some(format!(
            "at F{feed} {:.1} {unit} of {} are left, more than the {:.1} {unit} {than}",
            now.on.um,
            now.name(),
            before.um
        )),
        GlitchOrder::TurnsDiffer => Some(format!(
            "at F{feed} {:.1} {unit} of {} are left and {:.1} {unit} {than}, and turns of one circle differ by \
             {:.1} {unit}, which could turn the verdict: record both again",
            now.on.um,
            now.name(),
            before.um,
            now.on.spread_um.max(before.spread_um)
        )),
        GlitchOrder::Alike | GlitchOrder::Smaller => None,
    }
}

/// Returns the feeds, slowest first, at which off and on are alike on an axis in both directions, although at the
/// neighbouring feeds they are not. At the slowest one they may be: there compensation takes little away.
fn without_effect(recorded: &[BeforeAfter], axis: &str) -> Vec<f64> {
    const BETWEEN: f64 = 0.8;
    const FASTEST: f64 = 0.6;
    let stands_out = |it: &BeforeAfter, next: [&BeforeAfter; 2], part: f64| {
        !it.of_axis(axis).any(PlaceCompared::shows_an_effect)
            && next
                .iter()
                .all(|it| it.of_axis(axis).all(|it| it.leaves_at_most(part)))
    };
    let mut alike = Vec::new();
    for three in recorded.windows(3) {
        if stands_out(&three[1], [&three[0], &three[2]], BETWEEN) {
            alike.push(three[1].feed);
        }
    }
    if let [.., one, other, fastest] = recorded
        && stands_out(fastest, [one, other], FASTEST)
    {
        alike.push(fastest.feed);
    }
    alike
}

#[cfg(test)]
mod tests {
    use super::*;
    use frictcomp_physics::circle::MeasuredGlitch;

    /// Returns a glitch whose turns scatter, the largest of which counts.
    fn glitch(um: f64, median_um: f64, spread_um: f64) -> MeasuredGlitch {
        const NOISE_UM: f64 = 0.1;
        let mut glitch = MeasuredGlitch::of(um, spread_um.hypot(NOISE_UM));
        (glitch.median_um, glitch.spread_um, glitch.turns) = (median_um, spread_um, 3);
        glitch
    }

    /// Returns the objections to a list that leaves one glitch in place of another, at each of four feeds.
    fn against(off: MeasuredGlitch, on: MeasuredGlitch) -> Vec<String> {
        let feeds = [500.0, 1000.0, 2000.0, 5000.0];
        let place = PlaceCompared {
            axis: "X".to_owned(),
            direction: Some("ccw".to_owned()),
            off,
            on,
        };
        let recorded = feeds.map(|feed| BeforeAfter {
            feed,
            driven: feed,
            off: off.um,
            on: on.um,
            places: vec![place.clone()],
        });
        feeds_against(&JudgedRound {
            feeds: &feeds,
            recorded: &recorded,
            accepted: None,
            unit: "µm",
        })
    }

    #[test]
    fn only_a_spread_that_could_turn_the_verdict_stops_it() {
        // R16.11: more is left than without the list, but not by more than turns of one circle differ; or less, but more
        // than the median of the turns without it.
        let steady = glitch(20.0, 20.0, 0.0);
        for (off, on) in [
            (steady, glitch(22.0, 18.0, 2.0)),
            (glitch(20.0, 14.0, 3.0), glitch(18.0, 18.0, 0.0)),
        ] {
            let against = against(off, on);
            let words = "turns of one circle differ by";
            assert!(against.iter().any(|it| it.contains(words)), "{against:?}");
            assert!(against[0].contains("could turn the verdict"), "{against:?}");
            assert!(against[0].starts_with("at F500 ") && against[0].contains("X ccw"));
        }
        // The same spread where the list leaves much less.
        for (off, on) in [
            (steady, glitch(9.0, 6.0, 2.0)),
            (glitch(20.0, 14.0, 3.0), glitch(6.0, 6.0, 0.0)),
        ] {
            assert!(against(off, on).is_empty(), "{:?}", against(off, on));
        }
        // Where it leaves more by more than the spread, it is worse, whatever the turns do.
        let worse = against(steady, glitch(30.0, 28.0, 2.0));
        assert!(
            worse[0].contains("more than the 20.0 µm without it"),
            "{worse:?}"
        );
        assert!(!worse[0].contains("could turn"), "{worse:?}");
    }

    #[test]
    fn a_feed_that_the_accepted_lists_lack_is_no_proof() {
        // R16.12
        let recorded = |feeds: &[f64]| -> Vec<BeforeAfter> {
            let of = |feed: &f64| BeforeAfter {
                feed: *feed,
                driven: *feed,
                off: 20.0,
                on: 6.0,
                places: vec![PlaceCompared {
                    axis: "X".to_owned(),
                    direction: None,
                    off: glitch(20.0, 20.0, 0.0),
                    on: glitch(6.0, 6.0, 0.0),
                }],
            };
            feeds.iter().map(of).collect()
        };
        let feeds = [500.0, 1000.0, 2000.0, 5000.0];
        let against = feeds_against(&JudgedRound {
            feeds: &feeds,
            recorded: &recorded(&feeds),
            accepted: Some((2, &recorded(&feeds[1..]))),
            unit: "µm",
        });
        assert_eq!(
            against,
            ["F500 was not recorded with the lists of round 2, which may leave less"]
        );
    }
}
