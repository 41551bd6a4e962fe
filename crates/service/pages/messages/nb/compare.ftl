compare-heading = Sammenlign versjoner
compare-explained = To til fem versjoner: skriv et skip for dets aktive versjon, eller skip/nummer. Adressen til denne siden inneholder valget og kan deles.
compare-version-number = Versjon { $number }
compare-button = Sammenlign
compare-begin = Navn foreslås mens du skriver. Skip kan også merkes i <a href="/">listen over flåten</a> eller i <a href="/?ships=library">biblioteket</a>, og versjoner på siden til et skip. For eksempel: <a href="/compare?v=mariner&amp;v=kcs">Mariner og KCS</a>.
compare-speed = Utgangsfart
compare-turns = Svingesirkler med 35° ror mot styrbord
compare-turns-label = svingesirkler, 35° mot styrbord
compare-zigzags = Sikksakkprøver 20/20
compare-zigzags-label = sikksakkprøver 20/20
compare-criteria = Kriterier i IMO MSC.137(76)
compare-standard = Standardmanøvrer
compare-standard-explained = Simulert i stille, dypt vann, hver versjon fra sin egen utgangsfart. Forskjeller er i forhold til den første versjonen.
compare-coefficients-explained = Koeffisienter med samme navn er bare sammenlignbare når modellstrukturene er like.
compare-pass-limit = { $verdict }, grense { $limit }
compare-too-many = høyst { $most } versjoner kan sammenlignes
compare-not-simulated = { $version } kan ikke simuleres: { $reason }
