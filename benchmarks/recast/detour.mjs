/*
 * Walks over a triangle mesh by a navigation mesh of Recast and Detour.
 *
 * Reads one JSON value a line, answers each by one line. Metres, y up; a point is [x, y, z].
 *
 *   {"build": {positions, indices, config}}   flat arrays; config in Recast's units
 *       -> {ms, polygons, bytes}
 *   {"stand": [point, ...], reach}            reach: half the box to look in, [x, y, z]
 *       -> {places: [point | null, ...]}
 *   {"ways": [[point, point], ...], reach}
 *       -> {ways: [{stands, points, us}, ...]}
 *   stands: whether there is a place at either end; points: corners of a complete way, or none
 *   {"triangles": true}
 *       -> {positions, indices}               what is walkable, flat arrays
 */

import { createInterface } from "node:readline";
import {
  Detour,
  NavMeshQuery,
  exportNavMesh,
  getNavMeshPositionsAndIndices,
  init,
} from "@recast-navigation/core";
import { generateSoloNavMesh } from "@recast-navigation/generators";

const MAX_NODES = 65535;
const MAX_POLYGONS = 4096;

const vector = ([x, y, z]) => ({ x, y, z });
const point = ({ x, y, z }) => [x, y, z];

let navMesh;
let query;

function build({ positions, indices, config }) {
  query?.destroy();
  navMesh?.destroy();
  const begun = process.cpuUsage();
  const built = generateSoloNavMesh(positions, indices, config);
  const { user, system } = process.cpuUsage(begun);
  if (!built.success) throw new Error(built.error);
  navMesh = built.navMesh;
  query = new NavMeshQuery(navMesh, { maxNodes: MAX_NODES });
  const header = navMesh.getTile(0).header();
  return {
    ms: (user + system) / 1e3,
    polygons: header.polyCount(),
    bytes: exportNavMesh(navMesh).length,
  };
}

/** The polygon to stand on near a point, or null; the box alone would let in what only touches it. */
function place(position, reach) {
  const halfExtents = vector(reach);
  const { nearestRef, nearestPoint } = query.findNearestPoly(position, { halfExtents });
  const away = Math.hypot(nearestPoint.x - position.x, nearestPoint.z - position.z);
  const isNear = away <= reach[0] && Math.abs(nearestPoint.y - position.y) <= reach[1];
  return nearestRef && isNear ? { ref: nearestRef, at: nearestPoint } : null;
}

/** Corners of the way between two places, or none if it would end before the goal. */
function corners(start, goal) {
  const found = query.findPath(start.ref, goal.ref, start.at, goal.at, {
    maxPathPolys: MAX_POLYGONS,
  });
  const { polys } = found;
  try {
    const complete =
      found.success &&
      !(found.status & Detour.DT_PARTIAL_RESULT) &&
      polys.size > 0 &&
      polys.get(polys.size - 1) === goal.ref;
    return complete ? pulled(start, goal, polys) : [];
  } finally {
    polys.destroy();
  }
}

function pulled(start, goal, polys) {
  const result = query.findStraightPath(start.at, goal.at, polys, {
    maxStraightPathPoints: MAX_POLYGONS,
  });
  const points = [];
  for (let i = 0; i < 3 * result.straightPathCount; i += 3) {
    points.push([0, 1, 2].map((axis) => result.straightPath.get(i + axis)));
  }
  result.straightPath.destroy();
  result.straightPathFlags.destroy();
  result.straightPathRefs.destroy();
  return points;
}

function way([from, to], reach) {
  const begun = process.hrtime.bigint();
  const start = place(vector(from), reach);
  const goal = place(vector(to), reach);
  const points = start && goal ? corners(start, goal) : [];
  const us = Number(process.hrtime.bigint() - begun) / 1e3;
  return { stands: [start !== null, goal !== null], points, us };
}

function answer(request) {
  if (request.build) return build(request.build);
  if (request.stand) {
    const places = request.stand.map((position) => place(vector(position), request.reach));
    return { places: places.map((found) => found && point(found.at)) };
  }
  if (request.ways) return { ways: request.ways.map((pair) => way(pair, request.reach)) };
  if (request.triangles) {
    const [positions, indices] = getNavMeshPositionsAndIndices(navMesh);
    return { positions, indices };
  }
  throw new Error(`nothing known to do: ${Object.keys(request)}`);
}

await init();
for await (const line of createInterface({ input: process.stdin })) {
  let reply;
  try {
    reply = answer(JSON.parse(line));
  } catch (error) {
    reply = { error: error.message };
  }
  process.stdout.write(`${JSON.stringify(reply)}\n`);
}
