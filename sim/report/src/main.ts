import "uplot/dist/uPlot.min.css";
import "./style.css";
import { element } from "./dom";
import { pageOf } from "./page";
import { parseReport } from "./report";
import { startTheme } from "./theme";
import { kViews } from "./views/index";

function start(): void {
  startTheme();
  const report = parseReport(document.getElementById("leeway-report")?.textContent ?? "");
  const makeView = kViews[report.command];
  if (!makeView) throw new Error(`there is no page for 'leeway ${report.command}'`);
  document.body.append(pageOf(report, makeView(report)));
}

try {
  start();
} catch (error) {
  document.body.append(element("p", { class: "failed" }, `This report cannot be shown: ${error}`));
  throw error;
}
