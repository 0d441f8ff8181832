!> What the program says of a case in Portuguese: the answer to --check, the lines of a run and those of a study. Messages and notes
!> are English.
module portuguese
  use text_tools, only: printable, next_line
  implicit none
  private
  public :: in_language

  character(len=*), parameter :: newline = achar(10), note = newline//'  note: ', begins_line = newline//'  '
  character(len=*), parameter :: ends_word = ' ,;:)'//newline
  integer, parameter :: label_width = 17   !! characters of the longest label of a line of --check, and a blank

  !> English and Portuguese, in turn; * stands for one word, # for all up to a
  !> semicolon. Of the English texts that fit the longest one is taken. Names of models
  !> and of keys stay those of the case file.
  character(len=*), parameter :: phrases(*) = [character(len=84) :: &
    'ended early', 'parou antes do fim', &
    'done', 'concluída', &
    'not periodic within', 'não periódica em', &
    'repeats every revolution', 'repete-se a cada rotação', &
    'repeats every', 'repete-se a cada', &
    'recognised after', 'o que se reconheceu após', &
    'no contact', 'sem contato', &
    'contacts', 'contatos', &
    'faster', 'mais rápidos', &
    'than the theory holds', 'do que a teoria admite', &
    'deeper', 'mais profundos', &
    'penetration up to', 'penetração de até', &
    'film of at least', 'filme de no mínimo', &
    'its table good to', 'erro de sua tabela até', &
    'pin force up to', 'força no pino de até', &
    'force up to', 'força de até', &
    'pressure up to', 'pressão de até', &
    'in the last cycle', 'no último ciclo', &
    'not settled: the film thickness still changes by', 'não está em regime: a espessura do filme ainda muda', &
    'from cycle to cycle', 'de um ciclo para o outro', &
    'thinnest film', 'filme mais fino', &
    'thinnest', 'no mínimo', &
    'bearings', 'mancais', &
    'bearing', 'mancal', &
    'main bearing', 'mancal principal', &
    'piston skirt', 'saia do pistão', &
    'film at the skirt from', 'filme na saia de no mínimo', &
    'across the bore up to', 'velocidade transversal de até', &
    'Lyapunov exponent', 'expoente de Lyapunov', &
    'per revolution', 'por rotação', &
    'steps', 'passos', &
    'evaluations', 'avaliações', &
    'relative energy residual', 'resíduo relativo da energia', &
    'relative heat residual', 'resíduo relativo do calor', &
    'the pin turns', 'o pino gira', &
    'the pin drifts', 'o pino avança', &
    'a revolution and swings', 'por rotação e oscila', &
    'film with memory at the', 'filme com memória no', &
    'film with memory', 'filme com memória', &
    'in the run', 'na simulação', &
    'digits to the end', 'algarismos até o fim', &
    'digits to', 'algarismos até', &
    'then results of the whole run within', 'depois resultados da simulação inteira com erro de até', &
    'not certified: no tolerance ten times smaller is possible', 'sem certificado: não há tolerância dez vezes menor', &
    'not certified: the run at a hundredth of the tolerance could not continue', &
    'sem certificado: a simulação com um centésimo da tolerância não pôde continuar', &
    'correct', 'correto', &
    'runs/s', 'simulações/s', &
    'runs/min', 'simulações/min', &
    'runs', 'simulações', &
    'of them already done', 'delas já feitas', &
    'of them checked', 'delas verificadas', &
    'would fail', 'falhariam', &
    'with notes (column notes)', 'com avisos (coluna notes)', &
    'with notes', 'com avisos', &
    'machine', 'máquina', &
    'load', 'carga', &
    'speed', 'rotação', &
    'gas', 'gás', &
    'firing', 'ignição', &
    'piston pin', 'pino do pistão', &
    'piston pin: rod', 'pino do pistão: rod', &
    'small end', 'pé da biela', &
    'crank pin', 'pino da manivela', &
    'guide', 'guia', &
    'rings', 'anéis', &
    'run', 'simulação', &
    'results', 'resultados', &
    'film table', 'tabela do filme', &
    'note', 'aviso', &
    'stroke', 'curso', &
    'rod', 'biela', &
    'crank over rod', 'razão manivela/biela', &
    'axis off by', 'eixo deslocado de', &
    'dead centres at', 'pontos mortos em', &
    'bore', 'diâmetro', &
    'displacement', 'cilindrada', &
    'elastic rod', 'biela elástica', &
    'elastic crankshaft', 'virabrequim elástico', &
    'crankshaft of', 'virabrequim de', &
    'stations', 'estações', &
    'cylinders', 'cilindros', &
    'compression ratio', 'taxa de compressão', &
    'a cycle', 'por ciclo', &
    'released', 'liberados', &
    'largest at', 'máximo em', &
    'IMEP', 'PMI', &
    'dead space', 'volume morto', &
    'valves of', 'válvulas de', &
    'measured pressure', 'pressão medida', &
    'pressure set from outside', 'pressão dada por outro programa', &
    'repeated every', 'repetida a cada', &
    'order', 'ordem', &
    'every', 'a cada', &
    'after a ramp of', 'após uma rampa de', &
    'after', 'após', &
    'rows of up to', 'linhas de até', &
    'frame', 'referencial', &
    'journal', 'munhão', &
    'held', 'imposta', &
    'at first, free crank', 'no início, manivela livre', &
    'mean piston speed', 'velocidade média do pistão', &
    'quasi-static', 'quase-estático', &
    'of the load', 'da carga', &
    'clearance', 'folga', &
    'of the radius of', 'do raio de', &
    'length/diameter', 'comprimento/diâmetro', &
    '* film', 'filme *', &
    'at * degrees C', 'a * °C', &
    'at the start, heats up', 'no início, aquece', &
    'thins with the shear', 'afina com o cisalhamento', &
    'elastic walls', 'paredes elásticas', &
    'contact entry', 'entrada em contato', &
    'contact', 'contato', &
    'rough surfaces', 'superfícies rugosas', &
    'friction', 'atrito', &
    'wear', 'desgaste', &
    'the film is that of a long bearing, too thick below', 'o filme é o de um mancal longo, espesso demais abaixo de', &
    'the contact is that of two spheres, far too soft for a pin in its bearing', &
    'o contato é o de duas esferas, flexível demais para um pino em seu mancal', &
    'piston on the axis of the cylinder', 'pistão no eixo do cilindro', &
    'around a piston of', 'em torno de um pistão de', &
    'radius', 'de raio', &
    'with a film at the elastic skirt', 'com filme na saia elástica', &
    'with a film at the skirt', 'com filme na saia', &
    'tension', 'força tangencial', &
    'together', 'ao todo', &
    'oil', 'óleo', &
    'until the motion repeats', 'até o movimento repetir-se', &
    'at most', 'no máximo', &
    'of the crank, about', 'da manivela, cerca de', &
    'at the starting speed', 'à velocidade inicial', &
    'revolution', 'rotação', &
    'revolutions', 'rotações', &
    'in', 'em', &
    'method', 'método', &
    'relative tolerance', 'tolerância relativa', &
    'a row for each step', 'uma linha por passo', &
    'rows a revolution', 'linhas por rotação', &
    'a row every', 'uma linha a cada', &
    'about', 'cerca de', &
    'rows', 'linhas', &
    'columns in', 'colunas em', &
    'with its events', 'com seus eventos', &
    'and the ideal twin', 'e a simulação ideal', &
    'stored in #', 'guardada em #', &
    'must be computed, in about', 'deve ser calculada, em cerca de', &
    'degrees', 'graus', &
    'at main bearing', 'no mancal principal', &
    'at crank pin', 'no pino da manivela', &
    'at piston pin', 'no pino do pistão', &
    'at small end', 'no pé da biela', &
    'from', 'de', &
    'and', 'e', &
    'of', 'de', &
    'on', 'em', &
    'to', 'a', &
    'at', 'em']

contains

  !> A text of the program for its user in a language: `en`, as it is, or `pt`, in Portuguese with decimal commas, in which unknown
  !> words, and notes on a run, stay as they are.
  pure function in_language(text, language, names) result(said)
    character(len=*), intent(in) :: text       !! lines
    character(len=*), intent(in) :: language   !! en or pt
    character(len=*), intent(in) :: names      !! lines: texts of the user in it, which stay as they are, such as paths
    character(len=:), allocatable :: said, part
    integer :: i, next   ! a word begins at i; what follows `part` begins at `next`
    said = text
    if (language == 'en') return
    said = ''
    i = 1
    do while (i <= len(text))
      next = end_of_name(text, i, names)
      part = text(i:next - 1)
      if (next == i) call translate(text, i, part, next)
      said = said//part
      i = next
      do while (i <= len(text))   ! up to the next word
        if (index(text(i:), note) == 1) then
          next = i + len(note) + scan(text(i + len(note):)//newline, newline) - 1
          said = said//newline//'  aviso: '//text(i + len(note):next - 1)
          i = next
        else if (scan(text(i:i), ends_word//'(') == 1) then
          said = said//text(i:i)
          i = i + 1
        else
          exit
        end if
      end do
    end do
  end function in_language

  !> Where a name of the user ends that begins at `i`, with what follows it without a blank, as in FOLDER/NAME.csv; `i`: there is
  !> none. One that is no path stands only at the beginning of the text.
  pure integer function end_of_name(text, i, names) result(next)
    character(len=*), intent(in) :: text, names
    integer, intent(in) :: i
    character(len=:), allocatable :: name
    integer, parameter :: limits(2) = [200, 1000]   ! bytes to which names are shortened
    integer :: at, k
    next = i
    at = 1
    do while (at <= len(names))
      call next_line(names, at, name)
      if (i > 1 .and. index(name, '/') == 0) cycle
      do k = 1, size(limits)
        if (name /= '' .and. index(text(i:), printable(name, limits(k))) == 1) next = max(next, i + len(printable(name, limits(k))))
      end do
    end do
    if (next > i) next = next + scan(text(next:)//' ', ends_word) - 1
  end function end_of_name

  !> The longest phrase that begins at `i`, or else one word.
  pure subroutine translate(text, i, part, next)
    character(len=*), intent(in) :: text
    integer, intent(in) :: i
    character(len=:), allocatable, intent(out) :: part
    integer, intent(out) :: next   !! where the text goes on
    character(len=:), allocatable :: word, found
    integer :: k, length, longest, star
    longest = 0
    do k = 1, size(phrases), 2
      call match(text(i:), trim(phrases(k)), length, found)
      if (length <= longest) cycle
      longest = length
      part = trim(phrases(k + 1))
      word = found
    end do
    if (longest == 0) then
      longest = scan(text(i:)//' ', ends_word) - 1
      part = with_commas(text(i:i + longest - 1))
    else
      star = scan(part, '*#')
      if (star > 0) part = part(:star - 1)//with_commas(word)//part(star + 1:)
    end if
    next = i + longest
    if (i <= len(begins_line) .or. next > len(text)) return
    if (text(i - len(begins_line):i - 1) /= begins_line .or. text(next:next) /= ' ') return
    next = next + verify(text(next:)//'.', ' ') - 1   ! a label
    part = part//repeat(' ', max(1, label_width - characters(part)))
  end subroutine translate

  !> How much of the beginning of a text is a phrase and ends with a word; 0: it is another one.
  pure subroutine match(text, phrase, length, word)
    character(len=*), intent(in) :: text, phrase
    integer, intent(out) :: length
    character(len=:), allocatable, intent(out) :: word   !! that stands for * or #
    character(len=:), allocatable :: fitted
    integer :: star
    length = 0
    word = ''
    star = scan(phrase, '*#')
    if (star > 0) then
      if (index(text, phrase(:star - 1)) /= 1) return
      word = text(star:star + scan(text(star:)//' ', ends_word) - 2)
      if (phrase(star:star) == '#') word = text(star:star + scan(text(star:)//';', ';'//newline) - 2)
    end if
    fitted = phrase
    if (star > 0) fitted = phrase(:star - 1)//word//phrase(star + 1:)
    if (index(text, fitted) /= 1) return
    length = len(fitted)
    if (scan(text(length + 1:min(length + 1, len(text))), ends_word) == 0 .and. length < len(text)) length = 0
  end subroutine match

  !> A word with a comma between digits for the point, if it is a number with or without more behind it.
  pure function with_commas(word) result(said)
    character(len=*), intent(in) :: word
    character(len=len(word)) :: said
    integer :: i
    said = word
    if (scan(word, '/_=') > 0) return
    do i = 2, len(word) - 1
      if (word(i:i) == '.' .and. verify(word(i - 1:i - 1)//word(i + 1:i + 1), '0123456789') == 0) said(i:i) = ','
    end do
  end function with_commas

  !> Number of characters of a text in UTF-8.
  pure integer function characters(text)
    character(len=*), intent(in) :: text
    integer :: i
    characters = count([(iand(iachar(text(i:i)), 192) /= 128, i=1, len(text))])
  end function characters
end module portuguese
