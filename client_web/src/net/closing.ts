/** The meaning of a connection's end: its cause, what the server says of it, and whether to retry. */

import { CloseCode } from "./codes";
import type { Stated } from "./stated";

interface Meaning {
  cause: EndingCause;
  retry: boolean;
}

export interface Ending extends Meaning {
  /** The words of the server before it closed, if any. */
  stated: Stated | null;
}

const MEANINGS = {
  [CloseCode.NORMAL]: { cause: "normal", retry: true },
  [CloseCode.GOING_AWAY]: { cause: "goingAway", retry: true },
  [CloseCode.TOO_LARGE]: { cause: "tooLarge", retry: true },
  [CloseCode.BUSY]: { cause: "busy", retry: true },
  [CloseCode.UNSUPPORTED_VERSION]: { cause: "unsupportedVersion", retry: false },
  [CloseCode.MALFORMED]: { cause: "malformed", retry: true },
  [CloseCode.INVALID]: { cause: "invalid", retry: false },
  [CloseCode.FLOODING]: { cause: "flooding", retry: true },
  [CloseCode.HELLO_EXPECTED]: { cause: "helloExpected", retry: true },
  [CloseCode.HELLO_TIMEOUT]: { cause: "helloTimeout", retry: true },
  [CloseCode.SERVER_FULL]: { cause: "serverFull", retry: false },
  [CloseCode.TOO_SLOW]: { cause: "tooSlow", retry: true },
  [CloseCode.REPLACED]: { cause: "replaced", retry: false },
  [CloseCode.SILENT]: { cause: "silent", retry: true },
  [CloseCode.NAME_RESERVED]: { cause: "nameReserved", retry: false },
  [CloseCode.ADMISSION_NEEDED]: { cause: "admissionNeeded", retry: false },
  [CloseCode.PASSWORD_NEEDED]: { cause: "passwordNeeded", retry: false },
  [CloseCode.ADMISSION_REFUSED]: { cause: "admissionRefused", retry: false },
  [CloseCode.BANNED]: { cause: "banned", retry: false },
  [CloseCode.KICKED]: { cause: "kicked", retry: false },
} as const;

/** The end of a connection: by a close code, or by a silence that this page takes for one. */
export type EndingCause =
  | (typeof MEANINGS)[keyof typeof MEANINGS]["cause"]
  | "lost"
  | "serverSilent"
  | "noAnswer"
  | "unreadable";

const BY_CODE: ReadonlyMap<number, Meaning> = new Map(
  Object.entries(MEANINGS).map(([code, meaning]) => [Number(code), meaning]),
);

/** The end of a connection that was closed with a code. */
export function closing(code: number, stated: Stated | null): Ending {
  return { ...(BY_CODE.get(code) ?? { cause: "lost", retry: true }), stated };
}
