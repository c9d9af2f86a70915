//! What the recorded feeds of a round say against its lists (R16.9, R16.12, R16.15).

use frictcomp_physics::circle::GlitchOrder;

use super::compared::{BeforeAfter, PlaceCompared};

/// A round of lists, recorded off and on.
#[derive(Debug, Clone, Copy)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct JudgedRound<'a> {
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
pub fn feeds_against(round: &JudgedRound<'_>) -> Vec<String> {
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

/// The feeds, slowest first, at which off and on are alike on an axis in both directions, although at the
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
