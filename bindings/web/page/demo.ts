// A plate, whose first picture is its contour, and the program of the README with the lists of its machine.

import axisX from "../../../programs/demo/lists/axis_x.lis";
import axisY from "../../../programs/demo/lists/axis_y.lis";
import axisZ from "../../../programs/demo/lists/axis_z.lis";
import channel from "../../../programs/demo/lists/channel_1.lis";
import compX from "../../../programs/demo/lists/comp_x.lis";
import compY from "../../../programs/demo/lists/comp_y.lis";
import startup from "../../../programs/demo/lists/hochlauf.lis";
import plateMachine from "../../../programs/demo/contour/frictcomp.toml";
import plate from "../../../programs/demo/contour/plate.nc";
import configuration from "../../../programs/demo/frictcomp.toml";
import friction from "../../../programs/demo/friction.nc";
import next from "../../../programs/demo/next.nc";

/** Positions of the axes before the plate. */
export const DEMO_START = "X0, Y0, Z10";

export const DEMO: readonly [path: string, text: string][] = [
  ["example/contour/plate.nc", plate],
  ["example/contour/frictcomp.toml", plateMachine],
  ["example/friction.nc", friction],
  ["example/next.nc", next],
  ["example/frictcomp.toml", configuration],
  ["example/lists/hochlauf.lis", startup],
  ["example/lists/channel_1.lis", channel],
  ["example/lists/axis_x.lis", axisX],
  ["example/lists/axis_y.lis", axisY],
  ["example/lists/axis_z.lis", axisZ],
  ["example/lists/comp_x.lis", compX],
  ["example/lists/comp_y.lis", compY],
];
