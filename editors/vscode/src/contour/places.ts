/** Blocks and their places in the picture of a contour: geometry only, no page. */
import type { Stretch } from "../protocol";

export type Place = readonly [number, number];

/** The place of a line of a file in the picture. */
export interface Found {
  /** The stretches that the line drives; none if it has no stretch. */
  own: Stretch[];
  /** The nearest line above it in the picture, if it has no stretch. */
  above: Stretch | undefined;
}

/** The stretches of a line, or the last one of the nearest line above. */
export function find(stretches: readonly Stretch[], file: number, line: number): Found {
  const own = stretches.filter((it) => it.file === file && it.line === line);
  let above: Stretch | undefined;
  for (const it of own.length > 0 ? [] : stretches) {
    if (it.file === file && it.line < line && (above === undefined || it.line >= above.line)) {
      above = it;
    }
  }
  return { own, above };
}

/** The stretch nearest to a place, if it is not farther than `reach`. */
export function nearest(stretches: readonly Stretch[], place: Place, reach: number): Stretch | undefined {
  let best: Stretch | undefined;
  let least = reach;
  for (const it of stretches) {
    it.points.forEach((point, at) => {
      const far = distance(place, it.points[at - 1] ?? point, point);
      if (far < least) {
        best = it;
        least = far;
      }
    });
  }
  return best;
}

/** A machine time in words: `8.3 s`, `4 min 5 s`. */
export function machineTime(seconds: number): string {
  if (seconds < 60) {
    return `${seconds.toFixed(1)} s`;
  }
  const whole = Math.round(seconds);
  return `${Math.floor(whole / 60).toString()} min ${(whole % 60).toString()} s`;
}

/** The distance of a place from a straight line between two points. */
function distance([x, y]: Place, [fromX, fromY]: Place, [toX, toY]: Place): number {
  const along: Place = [toX - fromX, toY - fromY];
  const length = along[0] ** 2 + along[1] ** 2;
  const part = length === 0 ? 0 : ((x - fromX) * along[0] + (y - fromY) * along[1]) / length;
  const on = Math.min(Math.max(part, 0), 1);
  return Math.hypot(x - fromX - on * along[0], y - fromY - on * along[1]);
}
