/** Which view shows the answer of which command. */
import type { MakeView } from "../view";
import { compareView } from "./compare";
import { fuseView } from "./fuse";
import { intervalView } from "./interval";

export const kViews: Readonly<Record<string, MakeView>> = {
  compare: compareView,
  fuse: fuseView,
  interval: intervalView,
};
