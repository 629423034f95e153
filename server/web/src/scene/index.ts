/** What is drawn in 3-D, for the interface and for tests. */

export { ColorScale, MAPS, scaleOf, table } from "./colors";
export { extent, withoutOutliers } from "./data";
export { frames, inverse, multiply, quaternion, tip } from "./kinematics";
export { NoGraphics, Stage, type Camera, type Events, type Pick } from "./stage";
