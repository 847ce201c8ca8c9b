/** The server sent something that cannot be read. */
export class WireError extends Error {}
