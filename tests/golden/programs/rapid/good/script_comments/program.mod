MODULE M
  PROC main()
    ! a comment
    !%DRAW_SCENE
    Set do1; ! %EXEC_SCRIPT other;
    ! 50% of the parts
    FOR i FROM 1 TO 2 DO
      ! %hot_message round
    ENDFOR
    Reset do1;
    ! %DRAW_SCENE
  ENDPROC
ENDMODULE
