import ts from "typescript";
import { describe, expect, it } from "vitest";

/** All that people see or hear is made in these, but for shaders; `src/language/` has the words. */
const SOURCES = import.meta.glob<string>(
  ["../../src/main.ts", "../../src/{ui,app,input,render}/**/*.ts", "!../../src/render/cutaway.ts"],
  { query: "?raw", import: "default", eager: true },
);

/** Two words with a space between them, or one with a capital. */
const WORDS = /\p{L}{2,} +\p{L}{2,}|^\p{Lu}\p{Ll}+/u;

/** Texts that look like words and are for the browser: keys, fonts, and what a link is. */
const FOR_BROWSERS = /^(Enter|Escape|Home|End|(Arrow|Shift|Digit|Key)\w*)$|px |^noopener /;

/** The texts of a source that a person might be shown, with their lines. */
function wordsIn(source: string, path: string): string[] {
  const file = ts.createSourceFile(path, source, ts.ScriptTarget.ESNext, true);
  const found: string[] = [];
  const visit = (node: ts.Node): void => {
    if (isForProgrammers(node)) return;
    const text = textOf(node);
    if (text !== null && WORDS.test(text) && !FOR_BROWSERS.test(text)) {
      const { line } = file.getLineAndCharacterOfPosition(node.getStart());
      found.push(`${path}:${line + 1}: ${text}`);
    }
    ts.forEachChild(node, visit);
  };
  visit(file);
  return found;
}

function textOf(node: ts.Node): string | null {
  const isTemplate = ts.isTemplateHead(node) || ts.isTemplateMiddleOrTemplateTail(node);
  return ts.isStringLiteralLike(node) || isTemplate ? node.text.trim() : null;
}

/** Imports, types, and faults that nobody else reads. */
function isForProgrammers(node: ts.Node): boolean {
  const isFault = ts.isNewExpression(node) && node.expression.getText().endsWith("Error");
  return isFault || ts.isImportDeclaration(node) || ts.isTypeNode(node);
}

describe("the sources of the page", () => {
  it("hold no words for people, which are the catalogues'", () => {
    expect(Object.keys(SOURCES).length).toBeGreaterThan(80);
    const found = Object.entries(SOURCES).flatMap(([path, source]) => wordsIn(source, path));
    expect(found).toEqual([]);
  });

  it.each([
    'chip.textContent = "Not connected";',
    "note(`You follow ${name}.`);",
    'element("button", {}, "Close");',
    'element("small", { title: "show the plan" });',
  ])("would be found out by %s", (source) => {
    expect(wordsIn(source, "here.ts")).toHaveLength(1);
  });
});
