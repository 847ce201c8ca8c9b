/** Begins the operators' page. */

import "./frame/console";
