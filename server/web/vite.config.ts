// One self-contained ES module for all homes, its style sheet inside: a report and a notebook can load nothing else.
import { defineConfig } from "vite";

export default defineConfig({
  oxc: { jsx: { runtime: "automatic", importSource: "preact" } },
  build: {
    target: "es2022",
    outDir: "../wsrender_server/static/viewer",
    emptyOutDir: true,
    copyPublicDir: true,
    assetsInlineLimit: 100_000_000,
    rolldownOptions: { output: { minify: true } },
    lib: { entry: "src/main.ts", formats: ["es"], fileName: () => "viewer.js" },
  },
});
