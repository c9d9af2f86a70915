/** The settings that drive a contour: for the language server, and for the command line. */
import * as vscode from "vscode";

export interface ContourSettings {
  plant: string;
  plane: string[];
  start: Record<string, number>;
}

export function contourSettings(): ContourSettings {
  const settings = vscode.workspace.getConfiguration("frictcomp.contour");
  return {
    plant: settings.get("plant", ""),
    plane: settings.get<string[]>("plane", []),
    start: settings.get<Record<string, number>>("start", {}),
  };
}

export function contourOptions({ plant, plane, start }: ContourSettings): string[] {
  const positions = Object.entries(start).map(([axis, at]) => `${axis}=${at.toString()}`);
  return [
    ...(plant === "" ? [] : ["--plant", plant]),
    ...(plane.length === 0 ? [] : ["--plane", plane.join(",")]),
    ...(positions.length === 0 ? [] : ["--start", positions.join(",")]),
  ];
}
