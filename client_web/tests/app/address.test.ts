import { describe, expect, it } from "vitest";
import { linkToPerson, linkToPlace, readAddress } from "../../src/app/address";

describe("readAddress", () => {
  it("takes the operator key out and leaves the rest", () => {
    expect(readAddress("#operator=KEY")).toEqual({
      operator: "KEY",
      admission: null,
      zone: null,
      at: null,
      follow: null,
      lookYaw: null,
      rest: "",
    });
    const both = readAddress("#at=1,2,3&operator=a%20b&more");
    expect(both.operator).toBe("a b");
    expect(both.rest).toBe("#at=1,2,3&more");
    expect(readAddress("")).toMatchObject({ operator: null, at: null, lookYaw: null, rest: "" });
  });

  it("takes a pass or an invitation out too", () => {
    const pass = readAddress("#pass=abc&at=1,2");
    expect(pass.admission).toEqual({ way: "pass", secret: "abc" });
    expect(pass.rest).toBe("#at=1,2");
    const invitation = readAddress("#invitation=def");
    expect(invitation.admission).toEqual({ way: "invitation", secret: "def" });
    expect(invitation.rest).toBe("");
    expect(readAddress("#pass=").admission).toBeNull();
    expect(readAddress(`#pass=${"x".repeat(257)}`).admission).toBeNull();
  });

  it("reads a place, with or without a height", () => {
    expect(readAddress("#at=1.5,-2").at).toEqual({ x: 1.5, y: -2, z: 0 });
    expect(readAddress("#at=1,2,3").at).toEqual({ x: 1, y: 2, z: 3 });
  });

  it("reads the direction of the first view", () => {
    expect(readAddress("#at=1,2&look=90").lookYaw).toBeCloseTo(Math.PI / 2);
    expect(readAddress("#look=-45").lookYaw).toBeCloseTo(-Math.PI / 4);
    expect(readAddress("#look=0").lookYaw).toBe(0);
    for (const text of ["", "north", "361", "Infinity"]) {
      expect(readAddress(`#look=${text}`).lookYaw).toBeNull();
    }
  });

  it.each(["", "1", "1,", "a,b", "1,2,3,4", "1,NaN", "Infinity,0", "1,2,1e9"])(
    "reads no place where there is none: %s",
    (text) => {
      expect(readAddress(`#at=${text}`).at).toBeNull();
    },
  );
});

describe("links", () => {
  const page = "https://example.org/?v=1#operator=KEY";

  it("lead to a place and a view, and hold no secret", () => {
    const link = linkToPlace(page, { x: 1.234, y: -5, z: 3.5 }, Math.PI / 2);
    expect(link).toBe("https://example.org/?v=1#at=1.2,-5,3.5&look=90");
    expect(readAddress(new URL(link).hash)).toMatchObject({
      at: { x: 1.2, y: -5, z: 3.5 },
      lookYaw: Math.PI / 2,
    });
  });

  it("name the copy of a zone that they were made in", () => {
    const place = linkToPlace(page, { x: 1, y: 2, z: 0 }, 0, "hall-2");
    expect(place).toBe("https://example.org/?v=1#zone=hall-2&at=1,2,0&look=0");
    expect(readAddress(new URL(linkToPerson(page, "Ann", "hall")).hash)).toMatchObject({
      zone: "hall",
      follow: "Ann",
    });
    for (const text of ["", "A", "a/b", "x".repeat(33)]) {
      expect(readAddress(`#zone=${encodeURIComponent(text)}`).zone).toBeNull();
    }
  });

  it("lead to a person, whatever the name", () => {
    const link = linkToPerson(page, "Zoë & 王 #2");
    expect(link).not.toContain("KEY");
    expect(readAddress(new URL(link).hash).follow).toBe("Zoë & 王 #2");
    expect(readAddress("#follow=").follow).toBeNull();
  });
});
