MODULE M
  PROC main()
    IF 1=1 THEN
      FOR i FROM 1 TO 2 DO
    ENDIF
    ENDWHILE
    WHILE TRUE DO
      Set do1;
  ENDPROC
  PROC other()
    ELSE
    ENDFOR
    IF 1=1
    Set do2;
    ENDIF
    IF 1=1 FOR i FROM 1 TO 2 DO
    ENDFOR
  ENDPROC
  PROC last()
    IF 1=1 THEN
    ELSE
    ELSEIF 1=2 THEN
    ELSE
    ENDIF
ENDMODULE
