// Figures as people read them.

/** A number with four significant digits. */
export function number(x: number): string {
  if (!Number.isFinite(x)) return String(x);
  if (x === 0) return "0";
  const size = Math.abs(x);
  if (size >= 1e7 || size < 1e-4) {
    const [digits, power] = x.toExponential(3).split("e");
    return `${Number(digits)}·10${superscript(Number(power))}`.replace(/^-/, "−");
  }
  return String(Number(x.toPrecision(4))).replace("-", "−");
}

function superscript(power: number): string {
  const digits = "⁰¹²³⁴⁵⁶⁷⁸⁹";
  return (power < 0 ? "⁻" : "") + [...String(Math.abs(power))].map((d) => digits[Number(d)]).join("");
}

/** A unit in which values of this size read well. */
export interface Scale {
  factor: number;
  unit: string;
}

export function scale(greatest: number, unit: string): Scale {
  const raised = unit.replace("3", "³").replace("2", "²");
  if (["Pa", "N", "J"].includes(unit)) {
    for (const [factor, prefix] of [[1e9, "G"], [1e6, "M"], [1e3, "k"]] as const) {
      if (greatest >= factor) return { factor, unit: prefix + raised };
    }
  }
  if (["m", "s", "m/s"].includes(unit) && greatest > 0 && greatest < 0.1) {
    return { factor: 1e-3, unit: `m${raised}` };
  }
  return { factor: 1, unit: raised };
}

/** Round values that part a range into about `count` steps. */
export function ticks(low: number, high: number, count: number): number[] {
  const span = high - low;
  if (!(span > 0)) return [low];
  const rough = span / count;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((s) => s * power).find((s) => s >= rough)!;
  const all = [];
  for (let i = Math.ceil(low / step - 1e-9); i * step <= high + 1e-9 * span; i++) all.push(i * step);
  return all;
}
