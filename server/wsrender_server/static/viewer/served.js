// The page of `wsrender serve`: addresses are relative, so that it works behind a prefix.
import { mountServed } from "./viewer.js";

mountServed(document.getElementById("wsrender"));
