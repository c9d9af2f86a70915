import { describe, expect, it } from "vitest";
import type { Axis, Message, Overview } from "../page/answers";
import { told } from "../page/bars";
import { isMissing, missing, sentence, verdict } from "../page/verdict";

const axis: Axis = {
  name: "X", startUp: "active", start: "active", end: "active", listed: true, changes: 0,
  changedBy: [], possible: null, uncompensated: null, bar: [[1, 2, "active"], [3, 9, "inactive"]],
};

const overview: Overview = {
  program: "a.nc", name: null, axes: [axis], axesAsTheyOccur: false, blocks: 9, kept: 9,
  endedBy: "M30", remark: null, errors: 0, warnings: 0, infos: 0, messages: [], messagesLeftOut: 0,
  passedOver: [], isAssumed: false, items: 11, notableItems: 2,
  machine: { origin: "frictcomp.toml", isDescribed: true, lists: 1, missing: 0, said: [] },
};

const given = { enable: [], startups: 1 };

const message = (code: string, text: string): Message => ({
  code, severity: "error", message: text, help: [], file: "a.nc", line: 4, column: 1, axis: null, after: 3,
});

const weights = (changed: Partial<Overview>): string[] =>
  verdict({ ...overview, ...changed }, given).map(({ weight }) => weight);

describe("the verdict", () => {
  it("is good only where everything was looked at", () => {
    expect(weights({})).toEqual(["good"]);
    const notGood: Partial<Overview>[] = [
      { endedBy: "error", errors: 1 }, { endedBy: "budget" }, { endedBy: null }, { warnings: 1 },
      { remark: "no machine is described" }, { isAssumed: true }, { kept: 5 }, { messagesLeftOut: 1 },
      { axes: [] }, { infos: 1 }, { blocks: 0 },
      { axes: [{ ...axis, uncompensated: " off during 155 feed moves, the longest 812 mm" }] },
      { axes: [{ ...axis, startUp: "ineffective", end: "ineffective" }] },
      { axes: [{ ...axis, startUp: "unconfigured", end: "unconfigured" }] }, { axes: [{ ...axis, end: "inactive" }] }, { axes: [{ ...axis, end: "unknown" }] },
      { machine: { ...overview.machine, missing: 1 } },
      { machine: { ...overview.machine, isDescribed: false } },
      { machine: { ...overview.machine, said: [message("FC120", "wrong")] } },
    ];
    for (const changed of notGood) {
      expect(weights(changed), JSON.stringify(changed)).not.toContain("good");
    }
    expect(verdict(overview, { ...given, enable: ["X"] }).map(({ weight }) => weight)).not.toContain("good");
  });

  it("says when an axis ends how", () => {
    const words = "inactive if V.E.A == 2 (line 3), else active";
    const told = (changed: Partial<Axis>): string =>
      verdict({ ...overview, axes: [{ ...axis, end: "unknown", ...changed }] }, given)[0]?.text ?? "";
    expect(told({})).toContain("at the end: X. Only");
    expect(told({ possible: words })).toContain(`at the end: X (${words}). Only`);
  });

  it("names what was not dropped", () => {
    const called = message("FC320", "the called program `SUB.nc` was not found");
    const list = message("FC123", "`axis_x.lis`, named in line 3 of `hochlauf.lis`, is not found");
    const found = {
      ...overview, messages: [called], machine: { ...overview.machine, missing: 1, said: [list] },
    };
    expect(missing(found)).toEqual(["axis_x.lis", "SUB.nc"]);
    expect([isMissing(found, "deep/sub.NC"), isMissing(found, "other.nc")]).toEqual([true, false]);
    expect(verdict(found, given).map(({ text }) => text).join(" ")).toContain("SUB.nc");
  });

  it("is made of sentences", () => {
    expect(sentence("the trace begins")).toBe("The trace begins.");
    expect(sentence("`X` is off")).toBe("`X` is off.");
  });
});

describe("a bar", () => {
  it("is told in words", () => {
    expect(told(axis)).toBe("X: active, inactive from block 3");
  });
});
