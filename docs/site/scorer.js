// How search ranks what it finds: pages for users first, then the interfaces, then how it is built and what was decided
// and measured. A heading that says what is asked for goes before pages that have its words. Between equals, the shorter
// title goes first: Transparency before its approximations.
var Scorer = {
  score: ([docname, title, anchor, description, score, filename, kind]) => {
    if (kind === "title") score += 20;
    score -= title.length / 1000;
    if (/^(decisions|log|papers|bench)\//.test(docname)) return score - 50;
    if (/^(guides|reference|design|cpp_api|python_api)\/|^(CHANGELOG|changes|architecture|layers)$/.test(docname)) return score - 4;
    return docname === "index" ? score + 3 : score;
  },
  objNameMatch: 11,
  objPartialMatch: 6,
  objPrio: { 0: 15, 1: 5, 2: -5 },
  objPrioDefault: 0,
  title: 15,
  partialTitle: 7,
  term: 5,
  partialTerm: 2,
};
