import { defineConfig } from "vitest/config";

export default defineConfig({
  base: "./",
  build: {
    outDir: "../src/esplanade/server/client_assets",
    emptyOutDir: true,
    // The server answers with a strict content security policy: nothing may be inlined.
    assetsInlineLimit: 0,
    modulePreload: { polyfill: false },
    // This file lists the libraries in the bundle with their licences; the page links to it.
    license: { fileName: "licences.txt" },
    sourcemap: false,
    target: "es2022",
    chunkSizeWarningLimit: 900,
    // Two pages: people come in by the one, operators look after the world on the other.
    rolldownOptions: { input: ["index.html", "console.html"] },
  },
  server: {
    proxy: {
      "/ws": { target: "ws://localhost:8080", ws: true },
      "/api": { target: "http://localhost:8081", ws: true },
    },
  },
  test: {
    include: ["tests/**/*.test.ts"],
    environment: "node",
  },
});
