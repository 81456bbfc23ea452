// Fixed file names, so that two builds give the same bytes and the server can embed them by name.
//
// `vite build` makes the page of `armill serve` in dist; `vite build --mode site` the page without a server in dist-site.
import { defineConfig, type Plugin } from "vitest/config";

/** What the page without a server may load: its own files, and what it makes itself. Nothing is sent anywhere. */
const SITE_POLICY = [
  "default-src 'self'",
  "script-src 'self' 'wasm-unsafe-eval'",
  "style-src 'self' 'unsafe-inline'",
  "img-src 'self' data: blob:",
  "worker-src 'self' blob:",
  "frame-src 'self' blob:",
  "connect-src 'self'",
  "object-src 'none'",
  "base-uri 'none'",
  "form-action 'none'",
].join("; ");

/** One plain script, which browsers also load from a disk; the policy, and the mark that the page has its own program. */
const siteIndex: Plugin = {
  name: "site-index",
  transformIndexHtml: {
    order: "post",
    handler: (html) =>
      html
        .replace(/<script type="module" crossorigin/, "<script defer")
        .replace(/<link rel="stylesheet" crossorigin/, '<link rel="stylesheet"')
        .replace("<title>", `<meta http-equiv="Content-Security-Policy" content="${SITE_POLICY}" />\n    <meta name="armill-program" content="browser" />\n    <title>`),
  },
};

export default defineConfig(({ mode }) => {
  const site = mode === "site";
  return {
    base: "./",
    plugins: site ? [siteIndex] : [],
    build: {
      target: "es2022",
      outDir: site ? "dist-site" : "dist",
      emptyOutDir: true,
      modulePreload: { polyfill: false },
      cssCodeSplit: false,
      // Nothing is inlined as a data: address but pictures; scripts never.
      assetsInlineLimit: 0,
      chunkSizeWarningLimit: 1000,
      rollupOptions: {
        output: {
          entryFileNames: "app.js",
          assetFileNames: "app[extname]",
          ...(site
            ? { format: "iife" as const, inlineDynamicImports: true }
            : { chunkFileNames: "vendor.js", manualChunks: (id: string) => (id.includes("node_modules") ? "vendor" : undefined) }),
        },
      },
    },
    // A limit is there for what hangs: a busy machine takes minutes.
    test: { include: ["tests/unit/**/*.test.ts"], environment: "node", testTimeout: 600_000 },
  };
});
