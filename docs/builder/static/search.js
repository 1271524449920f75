// Pages that answer a question come before pages that mention a word: what is added to the score of a page, by folder.
var Scorer = {
  objNameMatch: 11, objPartialMatch: 6, objPrio: { 0: 15, 1: 5, 2: -5 }, objPrioDefault: 0, title: 15, partialTitle: 7, term: 5, partialTerm: 2,
  score: ([page, , , , score]) => {
    const more = { "how_to/troubleshooting": 12, "how_to/systems": 12, "reference/glossary": 8 }
    const byFolder = { tutorial: 9, how_to: 7, labs: 5, paddle: 5, gallery: 3, project: -6, benchmarks: -6 }
    return score + (more[page] ?? byFolder[page.split("/")[0]] ?? 0)
  },
}
