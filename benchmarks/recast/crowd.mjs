/*
 * Moves a crowd of Detour on a navigation mesh of Recast.
 *
 * Each line of the input is one JSON request, and each is answered by one line. Lengths are in
 * metres, y is up, and a point is [x, y, z].
 *
 *   {"begin": {positions, indices, config, actors: [point, ...], goals: [point, ...],
 *              people: [point, ...], agent, person}}     agent and person: parameters of Detour
 *       -> {agents}
 *   {"tick": {goals: [[actor, point], ...], people: [point, ...], velocities: [point, ...], dt}}
 *       -> {ms, places: [point, ...]}     ms: processor time of the crowd's update alone
 */

import { createInterface } from "node:readline";
import { Crowd, NavMeshQuery, init } from "@recast-navigation/core";
import { generateSoloNavMesh } from "@recast-navigation/generators";

const vector = ([x, y, z]) => ({ x, y, z });

let crowd;
let actors;
let people;

function begin({ positions, indices, config, actors: places, goals, people: others, ...kinds }) {
  const built = generateSoloNavMesh(positions, indices, config);
  if (!built.success) throw new Error(built.error);
  crowd = new Crowd(built.navMesh, {
    maxAgents: places.length + others.length,
    maxAgentRadius: Math.max(kinds.agent.radius, kinds.person.radius),
  });
  const query = new NavMeshQuery(built.navMesh);
  const on = (place) => query.findClosestPoint(vector(place)).point;
  actors = places.map((place) => crowd.addAgent(on(place), kinds.agent));
  people = others.map((place) => crowd.addAgent(on(place), kinds.person));
  goals.forEach((goal, k) => actors[k].requestMoveTarget(vector(goal)));
  return { agents: crowd.getActiveAgentCount() };
}

/** People are where they are told to be, and go on as fast as they are told. */
function place(person, [x, , z], velocity) {
  person.raw.set_npos(0, x);
  person.raw.set_npos(2, z);
  velocity.forEach((speed, axis) => person.raw.set_vel(axis, speed));
  person.requestMoveVelocity(vector(velocity));
}

function tick({ goals, people: places, velocities, dt }) {
  for (const [k, goal] of goals) actors[k].requestMoveTarget(vector(goal));
  places.forEach((at, k) => place(people[k], at, velocities[k]));
  const begun = process.cpuUsage();
  crowd.update(dt);
  const { user, system } = process.cpuUsage(begun);
  const found = actors.map((actor) => actor.position());
  return { ms: (user + system) / 1e3, places: found.map(({ x, y, z }) => [x, y, z]) };
}

await init();
for await (const line of createInterface({ input: process.stdin })) {
  let reply;
  try {
    const request = JSON.parse(line);
    reply = request.begin ? begin(request.begin) : tick(request.tick);
  } catch (error) {
    reply = { error: error.message };
  }
  process.stdout.write(`${JSON.stringify(reply)}\n`);
}
