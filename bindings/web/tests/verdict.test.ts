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
  passedOver: [], headline: { standing: "good", text: "nothing to do" }, items: 11, notableItems: 2,
  machine: { origin: "frictcomp.toml", isDescribed: true, lists: 1, missing: 0, said: [] },
};

const given = { startups: 1 };

const message = (code: string, text: string): Message => ({
  code, severity: "error", message: text, help: [], file: "a.nc", line: 4, column: 1, axis: null, after: 3,
});

const weights = (changed: Partial<Overview>): string[] =>
  verdict({ ...overview, ...changed }, given).map(({ weight }) => weight);

describe("the verdict", () => {
  it("is good only where everything was looked at", () => {
    expect(weights({})).toEqual(["good"]);
    const notGood: Partial<Overview>[] = [
      { headline: { standing: "open", text: "X may be left off" } }, { headline: null }, { blocks: 0 },
      { endedBy: "error", errors: 1 }, { endedBy: "budget" }, { endedBy: null }, { warnings: 1 }, { infos: 1 },
      { remark: "no machine is described" }, { kept: 5 }, { messagesLeftOut: 1 },
      { machine: { ...overview.machine, isDescribed: false } }, { headline: null, axes: [] },
      { axes: [{ ...axis, uncompensated: " off during 155 feed moves, the longest 812 mm" }] },
      { machine: { ...overview.machine, missing: 1 } },
      { machine: { ...overview.machine, said: [message("FC120", "wrong")] } },
    ];
    for (const changed of notGood) {
      expect(weights(changed), JSON.stringify(changed)).not.toContain("good");
    }
  });

  it("opens with the sentence of the engine, and says when an axis ends how", () => {
    const possible = "inactive if V.E.A == 2 (line 3), else active";
    const headline: Overview["headline"] = { standing: "open", text: "X may be left off" };
    const told = verdict({ ...overview, headline, axes: [{ ...axis, end: "unknown", possible }] }, given);
    expect(told.map(({ text }) => text)).toEqual(["X may be left off.", `X at the end: ${possible}.`]);
    const none = verdict({ ...overview, headline: null, axes: [{ ...axis, startUp: "unconfigured" }] }, given);
    expect(none.map(({ weight }) => weight)).toEqual(["info"]);
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
