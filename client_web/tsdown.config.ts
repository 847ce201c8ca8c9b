import { defineConfig } from "tsdown";

/** The package of the codec, for programs of others; the page is built by vite.config.ts. */
export default defineConfig({
  cwd: "codec",
  entry: "index.ts",
  outDir: "dist",
  format: "esm",
  platform: "neutral",
  target: "es2022",
  dts: true,
  fixedExtension: false,
});
