// Compares a program with the test vectors: `node read.mjs mine.mjs`.
//
// mine.mjs exports `solve(impact)`, which gets one impact as it stands in impacts.json and
// gives its answers by the same names, nested alike, as one number or an array of them; or
// null for an impact that it does not take.
import { readFileSync } from "node:fs";
import { resolve } from "node:path";
import { pathToFileURL } from "node:url";

// Each answer that is missing or off, with its error and what is allowed.
function* misses(found, answer, place = "") {
  for (const [name, wanted] of Object.entries(answer)) {
    const got = found[name];
    if (typeof wanted === "string" || got === undefined) {
      if (got !== wanted) yield `${place}${name} is ${got}, not ${wanted}`;
    } else if (!Array.isArray(wanted)) {
      yield* misses(got, wanted, `${place}${name}.`);
    } else {
      const numbers = wanted.slice(0, -1), allowed = wanted.at(-1);
      let error = Math.hypot(...numbers.map((number, i) => [got].flat()[i] - number));
      // A direction: the short way round.
      if (name === "pdof") error = Math.abs(error - 2 * Math.PI * Math.round(error / 2 / Math.PI));
      if (!(error <= allowed)) yield `${place}${name} is off by ${error}, of ${allowed} allowed`;
    }
  }
}

const { solve } = await import(pathToFileURL(resolve(process.argv[2])));
const { impacts } = JSON.parse(readFileSync(new URL("impacts.json", import.meta.url), "utf8"));
let compared = 0, wrong = 0;
for (const { answer, ...impact } of impacts) {
  const found = solve(impact);
  if (found === null) continue;
  compared += 1;
  for (const miss of misses(found, answer)) {
    wrong += 1;
    console.log(`impact ${impact.id}: ${miss}`);
  }
}
console.log(`${compared} impacts compared, ${wrong} answers off`);
process.exitCode = wrong || !compared ? 1 : 0;
