// Bundles the page into one HTML file and writes it as C++: node bundle.mjs OUTPUT.cpp
import { build } from "esbuild";
import { readFile, writeFile } from "node:fs/promises";

const [output] = process.argv.slice(2);
const { outputFiles } = await build({
  entryPoints: ["src/main.ts"],
  outdir: "out",
  bundle: true,
  minify: true,
  write: false,
  target: "es2022",
  legalComments: "none",
});
const textOf = (extension) => outputFiles.find((file) => file.path.endsWith(extension)).text;

// A function as replacement: in a string, $& and the like have a meaning.
const page = (await readFile("template.html", "utf8"))
  .replace("/* style */", () => textOf(".css"))
  .replace("/* script */", () => textOf(".js").replaceAll("</script", "<\\/script"));
const bytes = [...Buffer.from(page)];
if (bytes.some((byte) => byte > 127)) throw new Error("the page must be ASCII");
await writeFile(
  output,
  `#include "sim/report/report_template.hpp"

namespace leeway::cli {
namespace {
constexpr char kBytes[] = {${bytes.join(",")}};
}  // namespace
const std::string_view kReportTemplate(kBytes, sizeof kBytes);
}  // namespace leeway::cli
`,
);
