/** JSON whose whole numbers beyond 2^53 keep their digits: as values that `JSON.stringify` writes as they were read. */

const RAW = JSON as typeof JSON & { rawJSON?(text: string): object };
const WHOLE = /^-?[1-9]\d*$/;

export function parse(text: string): any {
  const exact = (_: string, value: unknown, context?: { source?: string }) => (RAW.rawJSON && Number.isInteger(value) && !Number.isSafeInteger(value) && WHOLE.test(context?.source ?? "") ? RAW.rawJSON(context!.source!) : value);
  return JSON.parse(text, exact);
}

export const isExact = (value: unknown): boolean => typeof value === "object" && value !== null && "rawJSON" in value;

/** A number that is typed. */
export const typedNumber = (text: string): number => (WHOLE.test(text.trim()) ? parse(text) : Number(text.replace(",", ".")));
