import { defineConfig } from "vite";

/** The package of the codec, for programs of others; the page is built by vite.config.ts. */
export default defineConfig({
  root: "codec",
  build: {
    lib: { entry: "index.ts", formats: ["es"], fileName: "index" },
    outDir: "dist",
    emptyOutDir: true,
    minify: false,
    target: "es2022",
    rolldownOptions: { external: ["@msgpack/msgpack"] },
  },
});
