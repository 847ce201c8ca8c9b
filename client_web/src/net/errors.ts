/** The server sent what cannot be read. */
export class WireError extends Error {}
