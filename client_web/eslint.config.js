import js from "@eslint/js";
import { defineConfig } from "eslint/config";
import tseslint from "typescript-eslint";

/** Folders that a folder may not import from; everyone may know the shape of messages and steps. */
const walls = {
  net: ["language", "world", "render", "input", "ui", "app", "console"],
  language: ["net", "world", "render", "input", "ui", "app", "console"],
  world: ["language", "net", "render", "input", "ui", "app", "console"],
  render: ["language", "net", "input", "ui", "app", "console"],
  input: ["language", "net", "render", "ui", "app", "console"],
  ui: ["render", "input", "app", "console"],
  app: ["console"],
  console: ["language", "render", "input", "ui", "app"],
};

/** `render` may use all of three.js; `world` may use its vectors, which need no WebGL. */
function threeIn(folder) {
  if (folder === "render") return [];
  const group = ["three", "three/**"];
  const math = ["MathUtils", "Quaternion", "Vector3", "Vector3Like"];
  return folder === "world"
    ? [{ group, allowImportNames: math, message: "world/ reckons, render/ draws." }]
    : [{ group, message: "Only render/ draws." }];
}

export default defineConfig(
  { ignores: ["node_modules/", "dist/", "codec/dist/"] },
  js.configs.recommended,
  ...tseslint.configs.strictTypeChecked,
  {
    languageOptions: {
      parserOptions: { projectService: true },
    },
    rules: {
      "@typescript-eslint/restrict-template-expressions": ["error", { allowNumber: true }],
    },
  },
  ...Object.entries(walls).map(([folder, forbidden]) => ({
    files: [`src/${folder}/**/*.ts`],
    rules: {
      "no-restricted-imports": [
        "error",
        {
          patterns: [
            {
              group: [
                ...forbidden.map((name) => `**/${name}/**`),
                "!**/net/messages",
                "!**/net/steps",
              ],
              message: `${folder}/ stands apart.`,
            },
            ...threeIn(folder),
          ],
        },
      ],
    },
  })),
);
