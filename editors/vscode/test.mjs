// The grammar on `fixture.tltl`, whose comments `// ^ scope` say what stands above them, and on the
// task files of the repository: `npm ci && npm test`.
import { readFileSync, readdirSync } from "node:fs";
import { createRequire } from "node:module";
import { fileURLToPath } from "node:url";
import path from "node:path";

const require = createRequire(import.meta.url);
const oniguruma = require("vscode-oniguruma");
const { INITIAL, Registry, parseRawGrammar } = require("vscode-textmate");
const here = path.dirname(fileURLToPath(import.meta.url));

const wasm = readFileSync(require.resolve("vscode-oniguruma/release/onig.wasm"));
await oniguruma.loadWASM(wasm.buffer.slice(wasm.byteOffset, wasm.byteOffset + wasm.length));
const grammarFile = path.join(here, "syntaxes/tltl.tmLanguage.json");
const registry = new Registry({
  onigLib: Promise.resolve({
    createOnigScanner: (patterns) => new oniguruma.OnigScanner(patterns),
    createOnigString: (text) => new oniguruma.OnigString(text),
  }),
  loadGrammar: async () => parseRawGrammar(readFileSync(grammarFile, "utf8"), grammarFile),
});
const grammar = await registry.loadGrammar("source.tltl");

// The tokens of each line: start, end and innermost scope.
function tokens(lines) {
  let stack = INITIAL;
  return lines.map((line) => {
    const { tokens, ruleStack } = grammar.tokenizeLine(line, stack);
    stack = ruleStack;
    return tokens.map(({ startIndex, endIndex, scopes }) => [startIndex, endIndex, scopes[scopes.length - 1]]);
  });
}

let checked = 0;
const failures = [];
function expect(where, scope, wanted) {
  checked += 1;
  if (!scope.startsWith(wanted)) failures.push(`${where}: ${scope}, not ${wanted}`);
}

const asserts = /^\/\/(?:<- | *\^ )([a-z][a-z.-]+)$/;
const lines = readFileSync(path.join(here, "fixture.tltl"), "utf8").split("\n");
const source = lines.filter((line) => !asserts.test(line));
const scopes = tokens(source);
let above = -1;
lines.forEach((line, number) => {
  const wanted = asserts.exec(line);
  if (!wanted) return (above += 1);
  const column = line.startsWith("//<-") ? 0 : line.indexOf("^");
  const [, , scope] = scopes[above].find(([start, end]) => start <= column && column < end);
  expect(`fixture.tltl:${number + 1}`, scope, wanted[1]);
});

// Files that compile: every character has a scope of its own, and words have those of their kind.
const WORDS = [
  [/^(true|false|none)$/, "constant.language"],
  [/^(and|or|not)$/, "keyword.operator.logical"],
  [/^[0-9][0-9_.e]*$/, "constant.numeric"],
  [/^(&&|\|\||!|=>|<=>|∧|∨|¬|⇒|⇔)$/, "keyword.operator.logical"],
  [/^(<=|>=|==|!=|<|>|≤|≥|≠)$/, "keyword.operator.comparison"],
  [/^(◇|○|□)$/, "keyword.operator.wordlike.temporal"],
];
const root = path.join(here, "../..");
const folders = ["examples/tasks", "examples/kitchen/tasks", "examples/control/tasks", "tests/data", "tests/data/tasks"];
const read = (file) => [file, readFileSync(path.join(root, file), "utf8")];
const files = folders.flatMap((folder) =>
  readdirSync(path.join(root, folder)).filter((name) => name.endsWith(".tltl")).map((name) => read(`${folder}/${name}`)),
);
const reference = read("docs/language.md")[1].split("```tltl\n").slice(1).map((rest) => rest.split("```")[0]);
files.push(...reference.map((text, i) => [`docs/language.md, block ${i}`, text]));
for (const [file, text] of files) {
  const lines = text.split("\n");
  tokens(lines).forEach((line, number) => {
    for (const [start, end, scope] of line) {
      const word = lines[number].slice(start, end).trim();
      const where = `${file}:${number + 1}: ${word}`;
      if (word === "" || scope.startsWith("comment")) continue;
      if (scope === "source.tltl" && !/^[{}()[\],;:.?\s]+$/.test(word)) expect(where, scope, "a scope");
      for (const [pattern, wanted] of WORDS) if (pattern.test(word)) expect(where, scope, wanted);
    }
  });
}

if (failures.length > 0 || checked < 300) {
  console.error(failures.join("\n"), `\n${failures.length} of ${checked} failed`);
  process.exit(1);
}
console.log(`${checked} scopes of ${files.length} files and the fixture are right`);
