/** Which view shows the answer of which command. */
import type { MakeView } from "../view";
import { analyzeView } from "./analyze";
import { atlasView } from "./atlas";
import { campaignView } from "./campaign";
import { compareView } from "./compare";
import { driftView } from "./drift";
import { fuseView } from "./fuse";
import { intervalView } from "./interval";
import { reduceView } from "./reduce";
import { replayView } from "./replay";

export const kViews: Readonly<Record<string, MakeView>> = {
  analyze: analyzeView,
  atlas: atlasView,
  campaign: campaignView,
  compare: compareView,
  drift: driftView,
  fuse: fuseView,
  interval: intervalView,
  reduce: reduceView,
  replay: replayView,
};
