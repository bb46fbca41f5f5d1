// A server of a folder, and a browser: what the tests of the lab share.
import { existsSync, readFileSync } from "node:fs";
import { createServer } from "node:http";
import { join, normalize } from "node:path";
import { gzipSync } from "node:zlib";
import { chromium, firefox } from "playwright-core";

const types = { html: "text/html", wasm: "application/wasm", svg: "image/svg+xml", css: "text/css", js: "text/javascript" };

/** Serves a folder, compressed if asked for; gives the address and what ends it. */
export function serve(folder, { compressed = false } = {}) {
  const packed = new Map();
  const pack = (file) => packed.get(file) ?? packed.set(file, gzipSync(readFileSync(file))).get(file);
  const server = createServer((request, answer) => {
    const path = normalize(decodeURIComponent(new URL(request.url, "http://localhost").pathname)).replace(/[\\/]$/, "/index.html");
    const file = join(folder, path);
    if (path.includes("..") || !existsSync(file)) return answer.writeHead(404).end();
    const head = { "content-type": types[path.split(".").pop()] ?? "text/plain" };
    if (compressed) answer.writeHead(200, { ...head, "content-encoding": "gzip" }).end(pack(file));
    else answer.writeHead(200, head).end(readFileSync(file));
  });
  return new Promise((resolve) => {
    server.listen(0, "localhost", () => resolve({ address: `http://localhost:${server.address().port}`, close: () => server.close() }));
  });
}

/** Chromium, or Firefox where the name of the program says so. */
export function launch(executablePath) {
  if (/firefox/.test(executablePath)) return firefox.launch({ executablePath });
  const args = ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"];
  return chromium.launch({ executablePath, args });
}

/** The screens on which pages are looked at. */
export const screens = [
  { name: "desk", viewport: { width: 1280, height: 800 }, colorScheme: "light" },
  { name: "dark", viewport: { width: 1280, height: 800 }, colorScheme: "dark" },
  { name: "telephone", viewport: { width: 390, height: 844 }, colorScheme: "light" },
];

/** A page that keeps what the console says and what is requested. */
export async function opened(browser, options = {}) {
  const context = await browser.newContext({ viewport: { width: 1280, height: 800 }, ...options });
  const page = await context.newPage();
  const [spoken, requested] = [[], []];
  page.on("console", (message) => spoken.push(message.text()));
  page.on("pageerror", (error) => spoken.push(error.message));
  page.on("request", (request) => /^(blob|data):/.test(request.url()) || requested.push(request.url()));
  return { page, spoken, requested, close: () => context.close() };
}

/** Waits until the answer stands for the case, errors and all. */
export async function answered(page, timeout = 60_000) {
  await page.waitForFunction(
    () => !document.querySelector("#result").classList.contains("stale") && document.querySelector("#stop").hidden && document.querySelector("#title").textContent !== "",
    undefined,
    { timeout },
  );
}
