/*
 * Answers queries to a navigation mesh of Recast and Detour.
 *
 * Each line of the input is one JSON request, and each is answered by one line. Lengths are in
 * metres, y is up, and a point is [x, y, z].
 *
 *   {"build": {positions, indices, config}}   flat arrays; config is in Recast's units
 *       -> {ms, polygons, bytes}
 *   {"stand": [point, ...], reach}            reach: half extents of the search box, [x, y, z]
 *       -> {places: [point | null, ...]}
 *   {"paths": [[point, point], ...], reach}
 *       -> {paths: [{stands, points, us}, ...]}
 *   stands: whether each end is on the mesh; points: corners of a complete path, or none
 *   {"triangles": true}
 *       -> {positions, indices}               the walkable triangles, flat arrays
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

/**
 * The polygon near a point, with the nearest point of it, or null.
 *
 * The box of the query also finds polygons that only touch it, so the distance is checked again.
 */
function place(position, reach) {
  const halfExtents = vector(reach);
  const { nearestRef, nearestPoint } = query.findNearestPoly(position, { halfExtents });
  const away = Math.hypot(nearestPoint.x - position.x, nearestPoint.z - position.z);
  const isNear = away <= reach[0] && Math.abs(nearestPoint.y - position.y) <= reach[1];
  return nearestRef && isNear ? { ref: nearestRef, at: nearestPoint } : null;
}

/** The corners of the path between two places, or none if it would end before the goal. */
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
    return complete ? straightened(start, goal, polys) : [];
  } finally {
    polys.destroy();
  }
}

function straightened(start, goal, polys) {
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

function path([from, to], reach) {
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
  if (request.paths) return { paths: request.paths.map((pair) => path(pair, request.reach)) };
  if (request.triangles) {
    const [positions, indices] = getNavMeshPositionsAndIndices(navMesh);
    return { positions, indices };
  }
  throw new Error(`unknown request: ${Object.keys(request)}`);
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
