/**
 * The reports in a real browser: node report_test.js PROGRAM SCENES WORK_FOLDER. Makes a report of
 * every command, opens each in headless Chromium and looks, points, zooms and downloads as a reader
 * would. Exits with 77 where there is no browser.
 */
import { chromium, type Browser } from "playwright-core";
import { existsSync } from "node:fs";
import { checkReport } from "./checks";
import { makeReports } from "./made_reports";

const kSkipped = 77;
const kBrowsers = ["/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"];
const kArguments = [
  "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run",
  "--disable-background-networking", "--disable-component-update", "--disable-sync",
];

const [program, scenes, work] = process.argv.slice(2) as [string, string, string];
const executablePath = kBrowsers.find(existsSync);
if (executablePath === undefined) {
  console.log(`skipped: no browser at ${kBrowsers.join(", ")} (apt-get install chromium)`);
  process.exit(kSkipped);
}

const reports = makeReports(program, scenes, work);
const browser: Browser = await chromium.launch({ executablePath, args: kArguments });
let failures = 0;
try {
  for (const report of reports) {
    try {
      await checkReport(browser, report);
      console.log(`ok: ${report.name}`);
    } catch (error) {
      ++failures;
      console.error(`FAILED: ${report.name}: ${error instanceof Error ? error.stack : error}`);
    }
  }
} finally {
  await browser.close();
}
process.exit(failures === 0 ? 0 : 1);
